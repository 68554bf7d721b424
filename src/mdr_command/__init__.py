"""Command line ``mdr``: queries without a server, parameter studies, and the server."""
