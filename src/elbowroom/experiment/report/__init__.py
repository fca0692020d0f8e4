"""The report: one HTML page with everything in it, plots and pictures as SVG."""
