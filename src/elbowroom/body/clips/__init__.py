"""Motion clips of the planning degrees of freedom: their form, the stock ones, curves through their keys."""
