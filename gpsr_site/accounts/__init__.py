"""How people come into their accounts: by name and password, or by a server for single sign-on."""
