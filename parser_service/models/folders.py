"""Which folders of runs may be on the disk."""

from __future__ import annotations

from django.db import models


class RunFolder(models.Model):
    """A run's folder. The row outlives the run, so that the folder can be removed afterwards.

    No foreign key: the row has to stay when the run goes. Folders without such a row are another
    database's and are left alone.
    """

    run_number = models.PositiveBigIntegerField(unique=True)
    orphaned_at = models.DateTimeField(null=True, blank=True)

    class Meta:
        ordering = ["run_number"]

    def __str__(self) -> str:
        return f"folder of run {self.run_number}"
