// Tells the server the time zone of this browser (gpsr_site/web/time_zones.py), so that days and hours are the reader's.
// A page that was answered before it was told has those of UTC.
const zone = Intl.DateTimeFormat().resolvedOptions().timeZone;
if (zone) document.cookie = `time_zone=${zone}; path=/; samesite=lax; max-age=31536000`;
