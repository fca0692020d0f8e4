"""Models of places in USD (.usda, .usdc, .usdz), read by usd-core: the extra `[usd]`."""
