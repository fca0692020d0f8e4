"""Who moves: skeleton, planning degrees of freedom, collision body, forward kinematics, clips and gait."""
