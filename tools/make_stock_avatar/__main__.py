"""Command line: write the stock avatar into the package, or to the path given."""

import sys
from pathlib import Path

from make_stock_avatar.assemble import stock_avatar

TARGET = Path(__file__).resolve().parents[2] / "src" / "elbowroom" / "body" / "data" / "stock.vrm"

if __name__ == "__main__":
    path = Path(sys.argv[1]) if len(sys.argv) > 1 else TARGET
    path.parent.mkdir(parents=True, exist_ok=True)
    data = stock_avatar()
    path.write_bytes(data)
    print(f"{path}: {len(data)} bytes")
