"""Between the network and the views: the web server, and what is refused before a view runs."""
