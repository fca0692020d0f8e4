"""Which node of a file is which bone of a humanoid: by names, by the tree's shape, by the user's word."""
