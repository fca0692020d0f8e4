"""What next: activity graphs, goal functions, the C-T roadmap, its search, and the root planner."""
