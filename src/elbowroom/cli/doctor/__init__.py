"""`elbowroom doctor`: what is installed, and how a server does under its users."""
