"""The card of a dataset: what it is, how it was made, what may be done with it."""

from collections import Counter
from pathlib import Path

from elbowroom.body.loading.permissions import Use
from elbowroom.dataset.columns import COLUMNS
from elbowroom.dataset.manifest import Manifest
from elbowroom.dataset.spec import STOCK, DatasetSpec
from elbowroom.errors import InputError
from elbowroom.experiment.opened import opened
from elbowroom.experiment.table1.tasks import AvatarFile

CARD = "README.md"


def write_card(folder: Path, manifest: Manifest) -> None:
    """Write the card; raises `InputError` where it cannot be written."""
    path = folder / CARD
    try:
        path.write_text(card(manifest), "utf-8")
    except OSError as error:
        raise InputError(f"{path}: cannot be written ({error.strerror})") from None


def card(manifest: Manifest) -> str:
    """The card's text, in the form that Hugging Face shows."""
    spec, shards = manifest.spec, manifest.shards
    kept, seconds = sum(one.walks for one in shards), sum(one.seconds for one in shards)
    reasons = Counter(_kind(why) for one in shards for why in one.rejected.values())
    columns = "\n".join(f"| `{column.name}` | {column.about} |" for column in COLUMNS)
    left_out = "\n".join(f"- {count}: {why}" for why, count in reasons.most_common()) or "- none"
    return f"""---
pretty_name: {spec.name}
license: {spec.license or "other"}
configs: [{{config_name: default, data_files: "walks-*.parquet"}}]
---
# {spec.name}

{kept} walks, {seconds / 60:.1f} minutes at {spec.fps} frames a second, of a humanoid that a simulated user steers
through clutter: waist, arms and head make way for what stands there. Another library than the planner's own, coal,
judged every walk 240 times a second; in those that are here the body touches nothing, not even itself.

Made by elbowroom {manifest.made_with.get("version", "")}, planner `{spec.planner}`, from seed {spec.seed}.
{spec.walks} walks were drawn from the places {_listed(spec.places)}; the avatars {_listed(spec.avatars)};
the walks {_listed(spec.swings)}; the ways of steering {_listed(tuple(dict.fromkeys(spec.steering)))}.

Left out:

{left_out}

## Columns

A row is a walk. Metres, radians, seconds; right-handed, Y up; an avatar faces +Z and has its left at +X.
Numbers are 32-bit floats where nothing else is said.

| column | shape, unit |
|---|---|
{columns}

## Avatars

{avatars_of(spec)}

## Made again

`elbowroom dataset check .` walks a sample again and compares it bit for bit: with the same version, on the kind of
processor that `manifest.json` names. Cite the software by its name, version and repository, and Hsu & Li, Intelligent
control of third-person avatars in virtual environments, 2006.
"""


def avatars_of(spec: DatasetSpec) -> str:
    """Who walks, and under which licence. No mesh is in a dataset: what is kept are joints and configurations."""
    return "\n".join(f"- {_about(name)}" for name in spec.avatars)


def check_licences(spec: DatasetSpec) -> None:
    """Raises `InputError` for avatars whose licence forbids handing out what is made of them."""
    for name in spec.avatars:
        if name != STOCK:
            why = opened(AvatarFile(Path(name))).meta.permissions.refusal(Use.EMBED)
            if why is not None:
                raise InputError(f"{name}: {why}")


def _about(name: str) -> str:
    humanoid = opened(AvatarFile(None if name == STOCK else Path(name)))
    meta = humanoid.meta
    said = [meta.title, ", ".join(meta.authors), meta.licence]
    return f"{Path(name).name}: " + ("; ".join(part for part in said if part) or "its file says nothing")


def _listed(names: tuple[str, ...]) -> str:
    return ", ".join(Path(name).name if "." in name else name for name in names)


def _kind(why: str) -> str:
    return "touches something" if why.startswith("touches") else why
