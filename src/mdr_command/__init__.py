"""The command line ``mdr``: the service's answers without a server, and the server."""
