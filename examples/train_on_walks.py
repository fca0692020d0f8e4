"""Walks as a PyTorch dataset: a network of one layer learns where the joints will be from where they were.

Make walks first: elbowroom dataset examples/dataset.json -o walks --walks 100
"""

import sys
from pathlib import Path

import numpy as np
import pyarrow.parquet as pq
import torch

WINDOW = 10  # frames that are seen


class Walks(torch.utils.data.Dataset):
    """Windows of the places of 22 joints, metres from the hips, and the frame that follows each."""

    def __init__(self, folder: Path) -> None:
        """Read all files of a dataset."""
        table = pq.read_table(sorted(folder.glob("*.parquet")), columns=["joints"])
        places = [np.array(walk, np.float32).reshape(-1, 22, 3) for walk in table.column("joints").to_pylist()]
        walks = [(walk - walk[:, :1]).reshape(len(walk), -1) for walk in places]
        self.windows = [walk[k : k + WINDOW + 1] for walk in walks for k in range(len(walk) - WINDOW)]

    def __len__(self) -> int:
        return len(self.windows)

    def __getitem__(self, k: int) -> tuple[torch.Tensor, torch.Tensor]:
        window = torch.from_numpy(self.windows[k])
        return window[:-1].flatten(), window[-1] - window[-2]


def main(folder: str = "walks") -> None:
    """Train for a moment and print how far off the guesses are, in millimetres."""
    if not list(Path(folder).glob("*.parquet")):
        raise SystemExit(f"{folder}: holds no walks; elbowroom dataset examples/dataset.json -o {folder} --walks 100")
    torch.manual_seed(0)
    loader = torch.utils.data.DataLoader(Walks(Path(folder)), batch_size=64, shuffle=True)
    network = torch.nn.Linear(WINDOW * 66, 66)
    optimizer = torch.optim.Adam(network.parameters(), 1e-3)
    for epoch in range(5):
        errors = []
        for seen, moved in loader:
            loss = torch.nn.functional.mse_loss(network(seen), moved)
            optimizer.zero_grad()
            loss.backward()
            optimizer.step()
            errors.append(1e3 * float(loss.detach()) ** 0.5)
        print(f"epoch {epoch + 1}: {np.mean(errors):6.2f} mm a frame, {len(loader.dataset)} windows")


if __name__ == "__main__":
    main(*sys.argv[1:2])
