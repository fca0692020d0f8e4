"""X3D (XML and Classic) and VRML97: files as a graph of nodes, and their shapes as triangles."""
