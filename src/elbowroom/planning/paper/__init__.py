"""The paper's planner as printed: activity graph, C-T roadmap, Figure 6, group after group."""
