"""Buffer views compressed with meshoptimizer (EXT_meshopt_compression, KHR_meshopt_compression), decoded."""
