"""Models of things and places in any format, each as one glTF."""
