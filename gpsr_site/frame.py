"""What every page shows around its content: the rail and the worker's state."""


def frame(request):
    return {}
