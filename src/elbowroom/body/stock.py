"""The stock avatar: a VRM 1.0 figure of our own (CC0), written by `tools/make_stock_avatar`."""

from pathlib import Path


def stock_avatar_path() -> Path:
    """The file of the stock avatar in the package."""
    return Path(__file__).parent / "data" / "stock.vrm"


def stock_fit_path() -> Path:
    """The file of its capsules, fitted beforehand."""
    return stock_avatar_path().with_suffix(".capsules.json")
