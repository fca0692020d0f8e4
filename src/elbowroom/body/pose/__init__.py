"""From degrees of freedom to joints and capsules, and back."""
