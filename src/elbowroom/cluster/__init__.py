"""Many machines: experiments, whose tasks are done on the nodes of a Ray cluster."""
