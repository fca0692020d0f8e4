"""Models of places: unit and axis, names left out, floors, passages and where to begin, against rooms of known size."""

import json
import math
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from elbowroom.errors import InputError
from elbowroom.formats.fields import Field
from elbowroom.formats.gltf import parse_gltf
from elbowroom.formats.packing import write_glb
from elbowroom.world.places import columns as cutting
from elbowroom.world.places.columns import columns_of
from elbowroom.world.places.inspection import facts_of
from elbowroom.world.places.options import PlaceOptions
from elbowroom.world.places.passages import passages_of
from elbowroom.world.places.place import Place
from elbowroom.world.places.reading import BOUNDS, parse_place, read_place
from elbowroom.world.places.shown import shown_glb
from elbowroom.world.places.survey import survey
from place_builder import TWO_ROOMS, Boxes, glb, write_place
from shared_data import SHARED, needs_shared

OPEN = PlaceOptions(drop=("Door_*",))


def place(boxes: Boxes = TWO_ROOMS, options: PlaceOptions = OPEN, z_up: bool = False) -> Place:
    return parse_place(glb(boxes, z_up), "rooms.glb", options)


def test_parts_keep_their_names_and_what_is_dropped_is_gone() -> None:
    found = place()
    assert {part.name for part in found.parts} == set(TWO_ROOMS) - {"Door_1"}
    assert found.triangles == 12 * (len(TWO_ROOMS) - 1)
    least, most = found.bounds
    assert least == pytest.approx([-2.2, -0.2, -0.2], abs=1e-5)
    assert most == pytest.approx([2.2, 2.7, 8.2], abs=1e-5)


def test_what_is_passable_is_there_and_does_not_stand() -> None:
    found = place(options=PlaceOptions(passable=("Door_?",)))
    assert [part.name for part in found.parts if not part.stands] == ["Door_1"]
    assert facts_of(survey(found)).passable == ("Door_1",)


def test_a_pattern_that_matches_nothing_is_a_note() -> None:
    found = place(options=PlaceOptions(drop=("Window_*", "Door_*"), passable=("door_1",)))
    assert found.notes == (
        "drop 'Window_*' matches no name in the file",
        "passable 'door_1' matches no name in the file",
    )


def test_what_nobody_sees_does_not_stand_and_what_is_not_read_is_told() -> None:
    gltf = parse_gltf(glb(TWO_ROOMS), "rooms.glb")
    content = dict(gltf.root.value)
    content["scenes"] = [{"nodes": [node for node in range(len(TWO_ROOMS)) if node != list(TWO_ROOMS).index("Table")]}]
    content["extensionsRequired"] = ["KHR_mesh_quantization", "KHR_texture_basisu", "VENDOR_walls"]
    found = parse_place(write_glb(content, bytes(gltf.buffers[0] or b"")), "rooms.glb")
    assert {part.name for part in found.parts} == set(TWO_ROOMS) - {"Table"}
    assert found.notes == (
        "nodes left out, since they are hidden or in another scene of the file: 1 with a mesh",
        "it needs 'VENDOR_walls', which is not read here: something may be missing",
    )
    assert "Table" not in {node.at("name").text() for node in shown_nodes(found) if node.at("mesh").present}


def shown_nodes(found: Place) -> list[Field]:
    return parse_gltf(shown_glb(found, 0.0), "shown.glb").root.at("nodes").items()


def test_what_hangs_on_a_dropped_node_is_dropped_with_it() -> None:
    text = (
        "#VRML V2.0 utf8\nDEF A Transform { children DEF B Shape { geometry Box {} } } DEF C Shape { geometry Box {} }"
    )
    found = parse_place(text.encode(), "a.wrl", PlaceOptions(drop=("A",)))
    assert [part.name for part in found.parts] == ["C"]


def test_everything_dropped_is_refused() -> None:
    with pytest.raises(InputError, match="all are dropped"):
        place(options=PlaceOptions(drop=("*",)))


def test_z_up_is_recognised_where_only_so_there_is_a_floor() -> None:
    found = place({name: TWO_ROOMS[name] for name in ("Floor", "Table")}, PlaceOptions(), z_up=True)
    assert found.up == "z"
    assert "although the format says +Y" in found.told[0]
    assert np.ptp(found.bounds, axis=0).ravel() == pytest.approx([8.4, 1.0, 4.4], abs=1e-5)
    assert place().up == "y"


def test_axis_unit_and_ground_may_be_told() -> None:
    found = place(options=PlaceOptions(scale=0.5, up="-z"))
    assert found.told == ("-Z is up, as told", "a unit is 0.5 m, as told")
    assert np.ptp(found.bounds, axis=0).ravel() == pytest.approx([2.2, 4.2, 1.45], abs=1e-5)
    assert survey(place(options=PlaceOptions(ground=0.8))).ground.height == 0.8


@pytest.mark.parametrize("up", ["x", "y", "z", "-x", "-y", "-z"])
def test_standing_a_model_up_is_a_rotation(up: str) -> None:
    turn = place(options=PlaceOptions(up=up)).to_metres[:3, :3]
    assert turn @ turn.T == pytest.approx(np.eye(3))
    assert np.linalg.det(turn) == pytest.approx(1.0)
    axis = np.zeros(3)
    axis["xyz".index(up[-1])] = -1.0 if up.startswith("-") else 1.0
    assert turn @ axis == pytest.approx([0.0, 1.0, 0.0])


@pytest.mark.parametrize(("unit", "metre"), [(1.0, 1.0), (100.0, 0.01), (1000.0, 0.001)])
def test_the_unit_of_loose_triangles_is_guessed_by_the_height_of_a_room(unit: float, metre: float) -> None:
    corners = unit * np.array([[0, 0, 0], [4, 0, 0], [4, 2.6, 5], [0, 2.6, 5]])
    text = "".join(f"v {x} {y} {z}\n" for x, y, z in corners) + "f 1 2 3\nf 1 3 4\n"
    found = parse_place(text.encode(), "a.obj")
    assert found.metre == metre
    assert "--scale tells otherwise" in found.told[1]


@pytest.mark.parametrize("size", [(12.0, 2.0, 9.0), (20.0, 9.0, 27.0), (44.0, 39.0, 44.0), (64.0, 15.4, 64.0)])
def test_halls_and_levels_in_metres_are_not_taken_for_rooms_in_feet(size: tuple[float, float, float]) -> None:
    x, y, z = size
    text = f"v 0 0 0\nv {x} 0 0\nv {x} {y} {z}\nv 0 {y} {z}\nf 1 2 3\nf 1 3 4\n"
    assert parse_place(text.encode(), "a.obj").metre == 1.0


@pytest.mark.parametrize(
    "options",
    [{"scale": 0.0}, {"scale": math.nan}, {"up": "up"}, {"ground": math.inf}, {"drop": ("",)}, {"drop": ("a",) * 200}],
)
def test_wrong_options_are_told(options: dict[str, object]) -> None:
    with pytest.raises(InputError):
        PlaceOptions(**options)  # type: ignore[arg-type]


def test_too_many_triangles_are_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    from dataclasses import replace

    from elbowroom.world.places import reading

    monkeypatch.setattr(reading, "BOUNDS", replace(BOUNDS, triangles=50))
    with pytest.raises(InputError, match=r"rooms\.glb: more than .* 50 triangles"):
        place()


def test_a_place_that_is_too_large_is_refused() -> None:
    with pytest.raises(InputError, match="--scale"):
        place(options=PlaceOptions(scale=1e5))


@settings(max_examples=8, deadline=None)
@given(st.integers(0, 2**32 - 1))
def test_columns_are_where_points_of_the_triangles_lie(seed: int) -> None:
    """Every point of a surface lies over a cell that says so, at its height; and no cell says more than is there."""
    rng = np.random.default_rng(seed)
    boxes = {f"box {i}": (rng.uniform(-1, 1, 3) * [1, 1, 1] + [0, 1, 0], rng.uniform(0.02, 0.6, 3)) for i in range(3)}
    found = place(boxes, PlaceOptions(up="y"))
    columns = columns_of(found)
    triangles = np.concatenate([part.vertices[part.faces] for part in found.parts])
    weights = rng.dirichlet((1.0, 1.0, 1.0), 200)
    points = np.einsum("sc,tcx->tsx", weights, triangles).reshape(-1, 3)
    ix = np.minimum(((points[:, 0] - columns.origin[0]) / columns.cell).astype(int), columns.shape[0] - 1)
    iz = np.minimum(((points[:, 2] - columns.origin[1]) / columns.cell).astype(int), columns.shape[1] - 1)
    for cell, height in zip(ix * columns.shape[1] + iz, points[:, 1], strict=True):
        mine = columns.cells == cell
        spread = np.where(columns.level[mine], columns.cell, 0.0) + 0.011
        assert np.any((columns.low[mine] - spread <= height) & (height <= columns.high[mine] + spread))
    least, most = found.bounds
    assert columns.low.min() >= least[1] - 0.011
    assert columns.high.max() <= most[1] + 0.011


def test_copies_of_a_thing_in_one_place_are_looked_over_once(monkeypatch: pytest.MonkeyPatch) -> None:
    floor, table = TWO_ROOMS["Floor"], TWO_ROOMS["Table"]
    once, often = (place({"Floor": floor} | {f"Table {i}": table for i in range(copies)}) for copies in (1, 500))
    looked: list[int] = []
    real = cutting.surface_keys

    def noted(triangles: cutting.Floats, cell: float, shape: tuple[int, int]) -> cutting.Ints | None:
        looked.append(len(triangles))
        return real(triangles, cell, shape)

    monkeypatch.setattr(cutting, "surface_keys", noted)
    few, many = columns_of(once), columns_of(often)
    assert looked == [24, 24]
    np.testing.assert_array_equal(few.cells, many.cells)
    np.testing.assert_array_equal(few.high, many.high)


def test_too_much_surface_is_refused_soon() -> None:
    layers = np.tile(np.array([[[0.0, 0.0, 0.0], [600.0, 0.0, 0.0], [0.0, 0.0, 600.0]]]), (400, 1, 1))
    layers[:, :, 1] = np.arange(400)[:, None]
    assert cutting.surface_keys(layers, 1.0, (600, 600), most=1_000_000) is None


def test_floors_are_found_with_what_can_be_walked_on() -> None:
    found = survey(place())
    assert [round(floor.height, 2) for floor in found.floors] == [0.0, 2.7]  # inside, and on the ceiling's upper side
    inside = found.floors[0]
    assert found.ground is inside
    doorway = 0.8 * 0.2
    assert inside.area == pytest.approx(2 * 16.0 + doorway - 0.64, rel=0.08)
    assert len([size for size in inside.regions()[1] if size > 0.5]) == 1


def test_a_roof_is_no_ground_however_much_larger_it_is_than_the_furnished_room_below() -> None:
    broad = {**TWO_ROOMS, "Ceiling": ((0, 2.6, 4), (7.0, 0.2, 12.0))}
    found = survey(place(broad))
    assert found.floors[1].area > 2.5 * found.floors[0].area
    assert found.ground is found.floors[0]
    unroofed = survey(place({name: box for name, box in broad.items() if name in ("Ceiling", "Table")}))
    assert unroofed.ground.height == pytest.approx(2.7, abs=0.02)  # there is no room below it


def test_the_passage_between_two_rooms_is_their_door() -> None:
    inside = survey(place()).floors[0]
    (door,) = passages_of(inside)
    assert door.width == pytest.approx(0.8, abs=2 * inside.columns.cell)
    assert math.hypot(door.x, door.z - 4.0) < 0.25


def test_a_closed_door_parts_the_rooms() -> None:
    inside = survey(place(options=PlaceOptions())).floors[0]
    assert len([size for size in inside.regions()[1] if size > 0.5]) == 2
    assert passages_of(inside) == []


def test_one_begins_where_there_is_room_and_a_free_way() -> None:
    found = survey(place())
    start, floor = found.beginning, found.ground
    for share in np.linspace(0.0, 1.0, 50):
        x = start.x + share * start.way * math.sin(start.heading)
        z = start.z + share * start.way * math.cos(start.heading)
        ix, iz = (int((a - b) / floor.columns.cell) for a, b in zip((x, z), floor.columns.origin, strict=True))
        assert floor.room[ix, iz] > 0.15
    assert start.way > 1.0


def test_beside_what_has_no_room_one_begins_outside() -> None:
    found = survey(place({"Pillar": ((0, 1, 0), (0.5, 2, 0.5))}, PlaceOptions()))
    least, _ = found.place.bounds
    assert found.beginning.z < least[2] - 1.0
    assert any("beside it" in note for note in found.notes)


def test_facts_are_plain_json(tmp_path: Path) -> None:
    from dataclasses import asdict

    facts = facts_of(survey(read_place(write_place(tmp_path / "rooms.glb"), OPEN)))
    assert json.loads(json.dumps(asdict(facts)))["left_out"] == ["Door_1"]
    assert facts.size == pytest.approx((4.4, 2.9, 8.4), abs=1e-3)


@needs_shared
@pytest.mark.parametrize(
    ("file", "told"),
    [
        ("nav_test.obj", ""),
        ("simple_room.glb", "although the format says +Y"),
        ("ecctrl_testMap.glb", ""),
        ("chess-board.glb", ""),
        ("dive_level.glb", ""),
        ("AC14-FZK-Haus/AC14-FZK-Haus.glb", ""),
        ("openhrp3_mockup/mockup_main.wrl", "+Z is up"),
        ("x3d_winter_and_spring/Pathway.x3d", ""),
        ("x3d_winter_and_spring/Bushes.x3d", ""),
        ("x3d_winter_and_spring/MainStage.x3d", ""),
    ],
)
def test_every_collected_place_is_read(file: str, told: str) -> None:
    assert SHARED is not None
    found = read_place(SHARED / "scenes" / file)
    assert found.triangles > 0
    assert told in found.told[0]


@needs_shared
def test_every_collected_world_is_read_or_refused_for_what_it_lacks() -> None:
    """Each has triangles, or is refused since it has none."""
    assert SHARED is not None
    files = sorted((SHARED / "scenes").rglob("*.wrl"))
    refused = {file.name: told for file in files if (told := _refusal(file))}
    assert len(refused) < len(files)
    assert all("there are no triangles" in told for told in refused.values())


def _refusal(file: Path) -> str:
    try:
        read_place(file)
    except InputError as error:
        return str(error)
    return ""


@needs_shared
@pytest.mark.parametrize(
    "file", ["AC14-FZK-Haus/AC14-FZK-Haus.ifc", "planning_benchmarks/vamp_mbm_ur5_problems.tar.bz2"]
)
def test_what_is_no_model_is_refused(file: str) -> None:
    assert SHARED is not None
    with pytest.raises(InputError, match="no model of a format that is read"):
        read_place(SHARED / "scenes" / file)


@pytest.mark.long
@needs_shared
def test_the_house_has_two_floors_and_its_doors_open() -> None:
    assert SHARED is not None
    file = SHARED / "scenes" / "AC14-FZK-Haus" / "AC14-FZK-Haus.glb"
    found = survey(read_place(file, PlaceOptions(drop=("IfcDoor_*",))))
    assert [round(floor.height, 1) for floor in found.floors] == [0.0, 2.7]
    assert sorted(found.ground.regions()[1])[-1] > 200.0
    closed = survey(read_place(file))
    assert len([size for size in closed.ground.regions()[1] if size > 2.0]) > 3


def test_of_boards_on_boards_the_topmost_is_the_ground() -> None:
    boards = {"Lower": ((0, 0.005, 0), (9.0, 0.01, 9.0)), "Upper": ((0, 0.025, 0), (9.0, 0.01, 9.0))}
    found = survey(place(boards, PlaceOptions()))
    assert [round(floor.height, 2) for floor in found.floors] == [0.03]
    assert found.ground.height == pytest.approx(0.03, abs=0.006)


def test_a_single_pattern_is_not_read_letter_by_letter() -> None:
    with pytest.raises(InputError, match="must be a tuple of patterns"):
        PlaceOptions(drop="IfcDoor_*")  # type: ignore[arg-type]
