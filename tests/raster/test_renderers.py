"""Who renders an image: OpenGL against float64, window by window, and what happens where OpenGL fails."""

from __future__ import annotations

import os
import sys
import threading
from collections.abc import Callable
from contextlib import nullcontext
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from test_raster import LONG_SITE, Truth, lists_of, one, random_frame, random_patterns

from voronoi_tiles.base.errors import RenderError
from voronoi_tiles.groups.wallpaper import GROUPS
from voronoi_tiles.raster import cpu, gl, hoff
from voronoi_tiles.raster import renderer as render
from voronoi_tiles.raster.block_lists import BlockLists
from voronoi_tiles.raster.frame import BLOCK, Frame, cell_frame, rectangle_frame
from voronoi_tiles.raster.gl import Device, GlError, Prepared, float32_error, gl_errors
from voronoi_tiles.raster.renderer import LabelImage, Provenance, Renderer, spot_check
from voronoi_tiles.raster.scene import Pattern, Scene

Images = tuple[NDArray[np.int32], NDArray[np.int32], NDArray[np.float32], NDArray[np.float32]]
Change = Callable[[int, Images], Images]

GROUP = pytest.mark.parametrize("group", list(GROUPS))
VARIANT = pytest.mark.parametrize("compute", [False, True], ids=["fragment", "compute"])

BIRD = one("p31m", {"segment": [[20, 7], [22, 3]]}, {"point": [18, 5]})
"""A pattern for everyone."""


def owners(image: LabelImage) -> NDArray[np.intp]:
    """The copies themselves: another image may have other labels for them."""
    return image.copies[np.stack((image.first, image.second))]


def same(one_image: LabelImage, other: LabelImage) -> bool:
    """Whether two images are the same bits."""
    return (
        bool((owners(one_image) == owners(other)).all())
        and one_image.d1.dtype == other.d1.dtype
        and one_image.d2.dtype == other.d2.dtype
        and bool((one_image.d1 == other.d1).all())
        and bool((one_image.d2 == other.d2).all())
    )


def assert_within_error(image: LabelImage, exact: LabelImage) -> float:
    """Assert that an image is right within its error, in every sample; gives the largest share of it that is used."""
    allowed = [image.error(distance) for distance in (exact.d1, exact.d2)]
    off = [np.abs(image.d1 - exact.d1), np.abs(image.d2 - exact.d2)]
    assert (off[0] <= allowed[0]).all()
    assert (off[1] <= allowed[1]).all()
    decided = exact.d2 - exact.d1 > 2 * allowed[1]
    assert (owners(image)[0] == owners(exact)[0])[decided].all()
    assert (image.first != image.second).all()
    assert (image.d1 <= image.d2 + (0.0 if image.provenance.method == "exact" else image.error(0.0))).all()
    return float(max((part / bound).max() for part, bound in zip(off, allowed, strict=True)))


@pytest.fixture
def no_context(monkeypatch: pytest.MonkeyPatch) -> None:
    """A thread that has made no context yet."""
    monkeypatch.setattr(gl, "_contexts", threading.local())


# --- OpenGL -------------------------------------------------------------------------------------------------


@GROUP
def test_opengl_agrees_with_float64(device: Device, group: str) -> None:
    """In every sample: distances within float32's bound, the same owner wherever that decides; by either shader."""
    used = []
    for pattern, rng in random_patterns(20, group, "plain", "special", "several"):
        frame = random_frame(pattern, rng)
        exact = Renderer("cpu").render(pattern, frame)
        for compute in (False, True) if device.has_compute else (False,):
            image = Renderer("gl", compute=compute).render(pattern, frame)
            used.append(assert_within_error(image, exact))
            assert image.d1.dtype == np.float32
            assert image.provenance.renderer == "gl"
            assert image.provenance.precision == "float32"
            assert image.provenance.device == device.name
            assert image.provenance.spots >= 16
            assert not image.provenance.fallback
        Truth(pattern).assert_right(image, rng, 6)
    assert 0.02 < max(used) < 0.5


EXTREMES = {
    "far": one("p3", {"segment": [[300005, 2], [300014, 9]]}),
    "long": one("p1", LONG_SITE, b=50.0, angle=77.0),
    "flat cell": one("p2", {"segment": [[4, 5], [4.2, 400]]}, b=900.0, angle=3.0),
    "curve": one("p4g", {"bspline": [[2, 3], [9, 9], [20, 1], [14, 14], [25, 4]]}),
    "centres": one("p6m", {"point": [0, 0]}, {"point": [30, 0]}),
}


@pytest.mark.parametrize("method", ["exact", "hoff"])
@pytest.mark.parametrize("pattern", EXTREMES.values(), ids=EXTREMES)
def test_opengl_in_any_frame(device: Device, pattern: Pattern, method: render.Method) -> None:
    """One sample, one column, odd sides, a tiny region, many cells, pixels that are not square."""
    home = complex(pattern.sites[0].nodes[0])
    size = abs(pattern.lattice.reduced_basis[1])
    for width, height, shape in (
        (1.0, 1.0, (1, 1)),
        (0.5, 2.0, (1, 70)),
        (1e-4, 1e-4, (17, 16)),
        (1.5, 1.1, (49, 33)),
        (1.5, 0.1, (20, 40)),
    ):
        region = (home.real, home.imag, home.real + width * size, home.imag + height * size)
        frame = rectangle_frame(region, *shape)
        image = Renderer("gl", method=method).render(pattern, frame)
        assert_within_error(image, Renderer("cpu").render(pattern, frame))
        assert image.first.shape == (frame.height, frame.width)
    assert device.name


@pytest.mark.parametrize("sides", [4, 8, 128])
@pytest.mark.parametrize("group", ["p2", "pgg", "p31m"])
def test_meshes_by_opengl(device: Device, group: str, sides: int) -> None:
    """Wrong by the stated error at most, and that much; nearly everywhere the heights are those of float64's meshes."""
    used = []
    for pattern, rng in random_patterns(21, group, "points", "several", "far"):
        frame = random_frame(pattern, rng)
        image = Renderer("gl", method="hoff", sides=sides).render(pattern, frame)
        mesh = Renderer("cpu", method="hoff", sides=sides).render(pattern, frame)
        used.append(assert_within_error(image, Renderer("cpu").render(pattern, frame)))
        for height, true in ((image.d1, mesh.d1), (image.d2, mesh.d2)):
            close = np.abs(height - true) <= image.error(true) - hoff.cone_error(sides) * true
            # Where a cone meets a tent the height jumps by the cone's error, and a sample there has either.
            assert (~close).sum() <= 2 + 0.005 * close.size
        Truth(pattern).assert_right(image, rng, 6)
        assert image.provenance.method == f"hoff, cones of {sides} sides"
        assert image.provenance.device == device.name
    assert max(used) > (0.5 if sides < 100 else 0.1)


@VARIANT
def test_opengl_renders_seams_bit_equal(device: Device, compute: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    """An image in windows is the image in one."""
    if compute and not device.has_compute:
        pytest.skip("no compute shaders")
    frame = rectangle_frame((-40.0, -30.0, 70.0, 55.0), 150, 90)
    for pattern in (BIRD, EXTREMES["curve"], EXTREMES["long"]):
        whole = Renderer("gl", compute=compute).render(pattern, frame)
        with monkeypatch.context() as patch:
            patch.setattr(render, "WINDOW", 32)
            parts = Renderer("gl", compute=compute).render(pattern, frame)
        assert len(parts.windows) == 15
        assert same(whole, parts)
        assert parts.provenance.renderer == "gl"


def test_renderers_in_turn(device: Device) -> None:
    """Several of them in one thread, of both methods and variants, do not disturb each other."""
    frame = cell_frame(BIRD.lattice, 40)
    renderers = [
        Renderer("gl"),
        Renderer("gl", method="hoff", sides=8),
        Renderer("gl", compute=device.has_compute),
        Renderer("gl", method="hoff"),
    ]
    before = [renderer.render(BIRD, frame) for renderer in renderers]
    after = [renderer.render(BIRD, frame) for renderer in reversed(renderers)]
    assert all(same(first, last) for first, last in zip(before, reversed(after), strict=True))
    assert gl.device() is device


def test_two_contexts_in_one_thread(device: Device) -> None:
    """The device that is found and the first one by number are two contexts: each renders in its own."""
    frame = cell_frame(BIRD.lattice, 40)
    mine, other = Renderer("gl"), Renderer("gl", device=0, method="hoff")
    exact = Renderer("cpu").render(BIRD, frame)
    for renderer in (mine, other, mine):
        assert_within_error(renderer.render(BIRD, frame), exact)
    assert gl.device() is device


@pytest.mark.parametrize("compute", [None, False, True])
@pytest.mark.parametrize("software", [False, True])
@pytest.mark.parametrize("able", [False, True])
def test_compute_shaders_are_for_devices_that_have_them(
    monkeypatch: pytest.MonkeyPatch, compute: bool | None, software: bool, able: bool
) -> None:
    """Asked for, refused, or by default: where there are any, and the device is no software."""
    asked: list[bool] = []

    def prepared(*_: Any, compute: bool) -> Prepared:
        asked.append(compute)
        raise GlError("seen")

    monkeypatch.setattr(gl, "Prepared", prepared)
    monkeypatch.setattr(Device, "has_compute", able)
    monkeypatch.setattr(Device, "is_software", software)
    monkeypatch.setattr(Device, "current", lambda _: nullcontext())
    frame = cell_frame(BIRD.lattice, 5)
    with pytest.raises(GlError, match="seen"):
        Device.__new__(Device).render_exact(lists_of(BIRD, frame), frame, compute=compute)
    assert asked == [(able and not software) if compute is None else compute]


def test_a_device_says_what_it_is(device: Device) -> None:
    """Name, version, limits."""
    assert device.info["GL_RENDERER"] in device.name
    assert ", OpenGL " in device.name
    assert device.is_software == ("llvmpipe" in device.name.lower() or device.is_software)
    assert device.largest_image >= 1024
    assert device.has_compute == (device.context.version_code >= 430)


def test_the_largest_image_is_what_all_limits_allow() -> None:
    """A texture's, and a viewport's in both directions."""
    device = Device.__new__(Device)
    for texture, viewport in ((4096, (9000, 8000)), (9000, (4096, 8000)), (9000, (8000, 4096))):
        device.info = {"GL_MAX_TEXTURE_SIZE": texture, "GL_MAX_VIEWPORT_DIMS": viewport}
        assert device.largest_image == 4096


def test_lists_larger_than_textures_are_refused(device: Device, monkeypatch: pytest.MonkeyPatch) -> None:
    """Rows wrap at the texture's width; what has too many lines is an error."""
    rows = np.arange(10_000, dtype=np.int32).reshape(5000, 2)
    table = device.table(rows, 2, "i4")
    assert (np.frombuffer(table.read(), np.int32).reshape(-1, 2)[:5000] == rows).all()
    table.release()
    monkeypatch.setitem(device.info, "GL_MAX_TEXTURE_SIZE", 1)
    with pytest.raises(GlError, match=r"a list of 5,000 is larger"):
        device.table(rows, 2, "i4")


def test_long_lists_are_refused(device: Device, monkeypatch: pytest.MonkeyPatch) -> None:
    """Where a loop of the shader would not run to its end, the processor renders."""
    frame = cell_frame(BIRD.lattice, 40)
    lists = lists_of(BIRD, frame)
    rounds = int((np.diff(lists.element_start[lists.run_start]) + 2 * np.diff(lists.run_start)).max())
    monkeypatch.setattr(gl, "_ROUNDS", rounds - 1)
    image = Renderer("auto").render(BIRD, frame)
    assert image.provenance.renderer == "cpu"
    assert f"about one block take {rounds} rounds" in image.provenance.fallback
    assert device.info


@VARIANT
@pytest.mark.parametrize(("runs", "each"), [(21_845, 1), (255, 255), (2, 32_765)])
def test_the_longest_lists_are_gone_through_to_the_end(device: Device, compute: bool, runs: int, each: int) -> None:
    """The nearest copies are the last ones: Mesa's llvmpipe ends a shader's loops after 65,535 rounds in all.

    What takes one more is refused, however short the single loops are.
    """
    if compute and not device.has_compute:
        pytest.skip("the device has no compute shaders")
    frame = Frame(0j, 1 + 0j, 1j, 2, 2)

    def lists(more: int) -> BlockLists:
        """One block: copies in a row, each of some points, which come nearer."""
        sizes = np.full(runs, each)
        sizes[0] += more
        label = np.repeat(np.arange(runs, dtype=np.int32), sizes)
        copies = np.zeros((runs, 3), np.intp)
        middle = (1000.0 - 900.0 * label / runs).astype(np.complex128)
        scene = Scene(0j, middle, np.zeros_like(middle), label, copies)
        centre, radius = np.array([frame.offsets(BLOCK / 2, BLOCK / 2)]), frame.half_diagonal(BLOCK)
        start = np.append(0, np.cumsum(sizes))
        every = np.arange(len(label), dtype=np.int32)
        return BlockLists(scene, 1, radius, centre, np.array([0, runs]), np.arange(runs, dtype=np.int32), start, every)

    first, second, _, _ = device.render_exact(lists(0), frame, compute=compute)
    assert (first == runs - 1).all()
    assert (second == runs - 2).all()
    with pytest.raises(GlError, match="rounds of loops, more than 65,535"):
        device.render_exact(lists(65_536 - runs * (each + 2)), frame, compute=compute)


@pytest.mark.parametrize(
    ("cells", "points"),
    [
        (9_000, 2),
        (16_000, 1),
        (40_000, 1),
    ],
)
def test_loops_run_to_their_end_or_not_at_all(device: Device, cells: int, points: int) -> None:
    """Thousands of copies in one block: the right image, or an error."""
    pattern = one("p1", *({"point": [5 + 9 * k, 3]} for k in range(points)), b=60.0, angle=90.0)
    side = 60.0 * cells**0.5
    frame = rectangle_frame((0.0, 0.0, side, side), BLOCK, BLOCK)
    lists = lists_of(pattern, frame)
    try:
        _, _, d1, _ = device.render_exact(lists, frame, compute=False)
    except GlError:
        return
    true = cpu.render(lists, frame)[2]
    assert (np.abs(d1 - true) <= float32_error(true, frame)).all()


def test_a_context_belongs_to_its_thread(device: Device) -> None:
    """Another thread gets one of its own; a renderer that is taken there falls back, and says why."""
    frame = cell_frame(BIRD.lattice, 20)
    mine = Renderer("auto")
    found: list[LabelImage] = []

    def work() -> None:
        found.extend((mine.render(BIRD, frame), Renderer("gl").render(BIRD, frame)))

    thread = threading.Thread(target=work)
    thread.start()
    thread.join()
    exact = Renderer("cpu").render(BIRD, frame)
    assert same(found[0], exact)
    assert "another thread" in found[0].provenance.fallback
    assert_within_error(found[1], exact)
    assert found[1].provenance.renderer == "gl"
    assert gl.device() is device
    assert same(Renderer("gl").render(BIRD, frame), found[1])


def test_a_failed_context_is_not_used_again(device: Device) -> None:
    """One context to a thread, until it is given up; then a new one."""
    assert gl.device() is device
    gl.forget(device)
    other = gl.device()
    assert other is not device
    frame = cell_frame(BIRD.lattice, 20)
    assert_within_error(Renderer("gl").render(BIRD, frame), Renderer("cpu").render(BIRD, frame))


# --- windows ------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("method", ["exact", "hoff"])
@pytest.mark.parametrize("window", [16, 64])
def test_seams_do_not_show(method: render.Method, window: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """An image in windows is the image in one, bit for bit; the windows are its parts, with their lists."""
    for group in ("p2", "p6") if method == "exact" else ("pg",):
        for pattern, rng in random_patterns(
            22, group, *(("plain", "special", "long")[: 3 if method == "exact" else 2])
        ):
            frame = replace(random_frame(pattern, rng), width=90, height=70)
            whole = Renderer("cpu", method=method).render(pattern, frame)
            with monkeypatch.context() as patch:
                patch.setattr(render, "WINDOW", window)
                parts = Renderer("cpu", method=method).render(pattern, frame)
            assert len(whole.windows) == 1
            assert same(whole, parts)
            seen = np.zeros((70, 90), int)
            for part in parts.windows:
                x, y = part.frame.column - frame.column, part.frame.row - frame.row
                seen[y : y + part.frame.height, x : x + part.frame.width] += 1
                assert max(part.frame.width, part.frame.height) <= window
                assert complex(part.frame.points(0.0, 0.0)) == complex(frame.points(x, y))
                assert len(part.candidates) == -(-part.frame.width // BLOCK) * -(-part.frame.height // BLOCK)
            assert (seen == 1).all()
            rows = [tuple(row) for row in parts.copies.tolist()]
            assert rows == sorted(set(rows))


# --- falling back -------------------------------------------------------------------------------------------


class StandIn:
    """In OpenGL's place: the image of the processor, rounded to float32, and changed in the way of the test."""

    name = "stand-in"

    def __init__(self, change: Change = lambda _, images: images, largest: int = 4096) -> None:
        """Take what becomes of each image, the first of which has number 1."""
        self.change, self.largest_image, self.calls = change, largest, 0

    def render_exact(self, candidates: BlockLists, frame: Frame, *, compute: bool | None = None) -> Images:
        """Render as Device does."""
        del compute
        self.calls += 1
        first, second, d1, d2 = cpu.render(candidates, frame)
        return self.change(self.calls, (first, second, d1.astype(np.float32), d2.astype(np.float32)))


def stand_in(monkeypatch: pytest.MonkeyPatch, change: Change = lambda _, images: images, **options: int) -> StandIn:
    """Put something in OpenGL's place."""
    device = StandIn(change, **options)
    monkeypatch.setattr(render, "find_device", lambda _=None: device)
    return device


def assert_fell_back(image: LabelImage, lines: list[str], reason: str) -> None:
    """Assert that an image is the processor's, and that one line says why."""
    exact = Renderer("cpu").render(image.pattern, image.frame)
    assert same(image, exact)
    assert image.provenance.renderer == "cpu"
    assert image.provenance.precision == "float64"
    assert image.provenance.device == exact.provenance.device
    assert reason in image.provenance.fallback
    assert image.provenance.spots == 0
    assert [float(image.error(d)) for d in (0.0, 60.0)] == [image.pattern.rounding(image.frame)] * 2
    (line,) = lines
    assert line.startswith(
        tuple(f"OpenGL {w} ({image.provenance.fallback}). Using the CPU renderer." for w in ("not available", "failed"))
    )
    assert "\n" not in line


def no_moderngl(patch: pytest.MonkeyPatch) -> None:
    """The package is not installed."""
    patch.setitem(sys.modules, "moderngl", None)


def no_library(patch: pytest.MonkeyPatch) -> None:
    """The package finds no OpenGL."""

    def create_context(**_: Any) -> None:
        raise Exception("libEGL.so\n not loaded")  # noqa: TRY002  (moderngl raises that)

    patch.setattr("moderngl.create_context", create_context)


def no_description(patch: pytest.MonkeyPatch) -> None:
    """A context that cannot be asked anything, with an error that has no text."""

    class Broken:
        @property
        def info(self) -> dict[str, Any]:
            raise MemoryError

    patch.setattr("moderngl.create_context", lambda **_: Broken())


def forked(patch: pytest.MonkeyPatch) -> None:
    """The process is the child of one that has used OpenGL."""
    patch.setattr(gl, "_makers", {os.getppid()})


def refused(patch: pytest.MonkeyPatch) -> None:
    """There is no device."""

    def device(_: int | None = None) -> Device:
        raise GlError("no device")

    patch.setattr(render, "find_device", device)


@pytest.mark.parametrize(
    ("fault", "reason", "remedy"),
    [
        (no_moderngl, "moderngl", " Install it with: pip install moderngl"),
        (no_library, "libEGL.so not loaded", " On Debian/Ubuntu: apt-get install libegl1 libgl1"),
        (no_description, "MemoryError", ""),
        (forked, "before this process was forked", ""),
        (refused, "no device", ""),
    ],
)
@pytest.mark.usefixtures("no_context")
def test_without_opengl_the_processor_renders(
    fault: Callable[[pytest.MonkeyPatch], None], reason: str, remedy: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """And says once why, and what to do; who insists on OpenGL gets an error."""
    fault(monkeypatch)
    lines: list[str] = []
    renderer = Renderer("auto", notice=lines.append)
    frame = cell_frame(BIRD.lattice, 25)
    for _ in range(2):
        assert_fell_back(renderer.render(BIRD, frame), lines, reason)
    assert lines[0].endswith(f"Using the CPU renderer.{remedy}")
    assert Renderer("auto").render(BIRD, frame).provenance.fallback == renderer.provenance().fallback
    with pytest.raises(RenderError, match=reason) as caught:
        Renderer("gl", notice=lines.append)
    assert caught.value.exit_code == 1
    assert caught.value.remedy
    assert "OpenGL failed" in str(caught.value)
    assert len(lines) == 1
    assert not Renderer("cpu", notice=lines.append).render(BIRD, frame).provenance.fallback
    assert len(lines) == 1


def test_no_such_device() -> None:
    """Whether there is any OpenGL or none."""
    with pytest.raises(RenderError):
        Renderer("gl", device=99)


def raise_error(_: int, images: Images) -> Images:
    """OpenGL fails."""
    del images
    raise GlError("GL_OUT_OF_MEMORY")


def d1_low(_: int, images: Images) -> Images:
    """The distances are a little too small."""
    first, second, d1, d2 = images
    return first, second, d1 * np.float32(1 - 1e-4), d2


def d2_high(_: int, images: Images) -> Images:
    """The other distances are a little too large."""
    first, second, d1, d2 = images
    return first, second, d1, d2 * np.float32(1 + 1e-4)


def no_number(_: int, images: Images) -> Images:
    """There is no distance at all."""
    first, second, d1, d2 = images
    return first, second, d1, np.full_like(d2, np.nan)


def strangers_own(_: int, images: Images) -> Images:
    """The owner is the wrong one of the two nearest."""
    first, second, d1, d2 = images
    return second, first, d1, d2


def empty_image(_: int, images: Images) -> Images:
    """What a device gives that has done nothing."""
    return tuple(np.zeros_like(image) for image in images)  # type: ignore[return-value]


FAULTS = pytest.mark.parametrize(
    ("change", "reason"),
    [
        (raise_error, "GL_OUT_OF_MEMORY"),
        (d1_low, "the spot check found sample"),
        (d2_high, "the spot check found sample"),
        (no_number, "the spot check found sample"),
        (empty_image, "the spot check found sample"),
        (strangers_own, "with the wrong owner"),
    ],
)


@FAULTS
def test_what_fails_while_rendering(change: Change, reason: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """The processor renders this image and all that follow; who insists on OpenGL gets an error."""
    device = stand_in(monkeypatch, change)
    lines: list[str] = []
    renderer = Renderer("auto", notice=lines.append)
    assert renderer.provenance().renderer == "gl"
    frame = cell_frame(BIRD.lattice, 25)
    for _ in range(2):
        assert_fell_back(renderer.render(BIRD, frame), lines, reason)
    assert device.calls == 1
    with pytest.raises(RenderError, match=reason) as caught:
        Renderer("gl", notice=lines.append).render(BIRD, frame)
    assert caught.value.exit_code == 1
    assert len(lines) == 1


@FAULTS
def test_what_fails_in_the_middle_of_an_image(change: Change, reason: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """One image has one renderer: it is begun again."""
    device = stand_in(monkeypatch, lambda count, images: change(count, images) if count == 3 else images, largest=40)
    lines: list[str] = []
    renderer = Renderer("auto", notice=lines.append)
    assert_fell_back(renderer.render(BIRD, cell_frame(BIRD.lattice, 70)), lines, reason)
    assert device.calls == 3
    device.calls = 0
    insisting = Renderer("gl")
    with pytest.raises(RenderError, match=reason):
        insisting.render(BIRD, cell_frame(BIRD.lattice, 70))
    assert device.calls == 3


def test_what_does_not_fail(monkeypatch: pytest.MonkeyPatch) -> None:
    """A sound device renders all windows, no larger than it can; the spots of all are counted."""
    device = stand_in(monkeypatch, largest=40)
    lines: list[str] = []
    image = Renderer("auto", notice=lines.append).render(BIRD, cell_frame(BIRD.lattice, 70))
    assert device.calls == len(image.windows) == 9
    assert max(part.frame.width for part in image.windows) == 32
    assert not lines
    assert image.d1.dtype == np.float32
    assert str(image.provenance) == "exact on gl (stand-in), float32"
    assert image.provenance == Provenance("gl", "stand-in", "float32", "exact", "", image.provenance.spots)
    assert image.provenance.spots == 9 * Renderer("auto").render(BIRD, cell_frame(BIRD.lattice, 25)).provenance.spots
    assert_within_error(image, Renderer("cpu").render(BIRD, image.frame))


def test_the_error_of_meshes_is_that_of_the_farthest(monkeypatch: pytest.MonkeyPatch) -> None:
    """Windows are drawn to different depths: the deepest rules for the image."""
    device = stand_in(monkeypatch, largest=40)
    depths = iter([100.0, 1e6, 10.0, 1.0])

    def render_hoff(device: StandIn, candidates: BlockLists, frame: Frame, *, sides: int) -> tuple[Any, ...]:
        del sides
        return *device.render_exact(candidates, frame), next(depths)

    monkeypatch.setattr(hoff, "render_hoff", render_hoff)
    frame = cell_frame(BIRD.lattice, 50)
    image = Renderer("auto", method="hoff").render(BIRD, frame)
    assert device.calls == len(image.windows) == 4
    rounding = BIRD.rounding(frame)
    assert float(image.error(7.0)) == hoff.mesh_error(7.0, frame, farthest=1e6) + rounding
    assert float(image.error(7.0)) > 16 * 2.0**-24 * 1e6


def corrupt_exact(patch: pytest.MonkeyPatch) -> None:
    """The driver's image is wrong."""
    sound = Device.render_exact
    patch.setattr(Device, "render_exact", lambda *given, **options: d1_low(1, sound(*given, **options)))


def corrupt_hoff(patch: pytest.MonkeyPatch) -> None:
    """The driver's meshes are wrong."""
    sound = hoff.render_hoff

    def render_hoff(*given: Any, **options: Any) -> Any:
        first, second, d1, d2, farthest = sound(*given, **options)
        return second, first, d1, d2, farthest

    patch.setattr(hoff, "render_hoff", render_hoff)


def flag_in_draw(patch: pytest.MonkeyPatch) -> None:
    """OpenGL raises a flag, and nobody is told."""
    sound = Prepared.draw

    def draw(prepared: Prepared) -> None:
        sound(prepared)
        prepared.device.context.line_width = -1.0

    patch.setattr(Prepared, "draw", draw)


def flag_in_layer(patch: pytest.MonkeyPatch) -> None:
    """The same in a mesh."""
    sound = hoff._Meshes.layer

    def layer(meshes: Any, *, second: bool) -> Any:
        meshes.device.context.line_width = -1.0
        return sound(meshes, second=second)

    patch.setattr(hoff._Meshes, "layer", layer)


def driver_raises(patch: pytest.MonkeyPatch) -> None:
    """The driver fails in its own way."""

    def read(_: Prepared) -> None:
        raise ValueError("mapping\nfailed")

    patch.setattr(Prepared, "read", read)


def lists_do_not_fit(patch: pytest.MonkeyPatch) -> None:
    """No memory for the lists."""

    def table(*_: Any) -> None:
        raise MemoryError

    patch.setattr(Device, "table", table)


@pytest.mark.parametrize(
    ("fault", "method", "reason"),
    [
        (corrupt_exact, "exact", "the spot check found sample"),
        (corrupt_hoff, "hoff", "with the wrong owner"),
        (flag_in_draw, "exact", "GL_INVALID_VALUE"),
        (flag_in_layer, "hoff", "GL_INVALID_VALUE"),
        (driver_raises, "exact", "mapping failed"),
        (lists_do_not_fit, "exact", "MemoryError"),
    ],
)
def test_what_fails_in_opengl(
    device: Device,
    fault: Callable[[pytest.MonkeyPatch], None],
    method: render.Method,
    reason: str,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """A real context, and one thing about it that is broken; the next renderer makes a new one."""
    frame = cell_frame(BIRD.lattice, 25)
    lines: list[str] = []
    with monkeypatch.context() as patch:
        fault(patch)
        image = Renderer("auto", method=method, compute=False, notice=lines.append).render(BIRD, frame)
        with pytest.raises(RenderError, match=reason) as caught:
            Renderer("gl", method=method, compute=False).render(BIRD, frame)
    assert caught.value.exit_code == 1
    assert reason in image.provenance.fallback
    assert image.provenance.renderer == "cpu"
    assert len(lines) == 1
    assert reason in lines[0]
    assert same(image, Renderer("cpu", method=method).render(BIRD, frame))
    sound = Renderer("gl", method=method).render(BIRD, frame)
    assert_within_error(sound, Renderer("cpu").render(BIRD, frame))
    assert gl.device() is not device


# --- the spot check -----------------------------------------------------------------------------------------


@pytest.mark.parametrize("shape", [(1, 1), (64, 48)])
def test_the_spot_check_knows_the_bound(shape: tuple[int, int]) -> None:
    """It accepts half of the error, and no more than the whole."""
    frame = rectangle_frame((0.0, 0.0, 50.0, 40.0), *shape)
    lists = lists_of(BIRD, frame)
    first, second, d1, d2 = cpu.render(lists, frame)
    allowed = 1e-3
    for share in (0.0, 0.5, -0.5):
        images = (first, second, d1 + share * allowed, d2 - share * allowed)
        assert spot_check(lists.scene, frame, images, lambda _: allowed) >= 16
    for change in ((2.0, 0.0), (-2.0, 0.0), (0.0, 2.0), (0.0, -2.0), (np.nan, 0.0), (0.0, np.inf)):
        images = (first, second, d1 + change[0] * allowed, d2 + change[1] * allowed)
        with pytest.raises(GlError, match=r"the spot check found sample \(\d+, \d+\) off by more than 0.001"):
            spot_check(lists.scene, frame, images, lambda _: allowed)
    for wrong in (second, np.full_like(first, -1), np.full_like(first, len(lists.scene.copies))):
        with pytest.raises(GlError, match=r"wrong owner|labels of no copy"):
            spot_check(lists.scene, frame, (wrong, second, d1, d2), lambda _: allowed)


def test_the_spot_check_leaves_ties_alone() -> None:
    """Where the error decides nothing either of the two may own."""
    pattern = one("pm", {"segment": [[9, 3], [14, 20]]}, b=60.0)
    mirror = Frame(0j, 0j + 1e-9, 60j / 50, 1, 50, (0.0, 0.5))
    lists = lists_of(pattern, mirror)
    first, second, d1, d2 = cpu.render(lists, mirror)
    assert np.abs(d2 - d1).max() < 1e-8
    spot_check(lists.scene, mirror, (second, first, d1, d2), lambda _: 1e-7)


def test_the_spot_check_looks_everywhere(monkeypatch: pytest.MonkeyPatch) -> None:
    """A quarter of an image gone wrong is seen, whichever it is; fewer samples are taken where each is more work."""
    frame = cell_frame(BIRD.lattice, 64)
    lists = lists_of(BIRD, frame)
    sound = cpu.render(lists, frame)
    for rows in (slice(None, 32), slice(32, None)):
        for columns in (slice(None, 32), slice(32, None)):
            d1 = sound[2].copy()
            d1[rows, columns] += 1.0
            with pytest.raises(GlError):
                spot_check(lists.scene, frame, (sound[0], sound[1], d1, sound[3]), lambda _: 1e-3)
    for work, count in ((100 * len(lists.scene), 100), (1, 16)):
        monkeypatch.setattr(render, "_SPOT_WORK", work)
        assert spot_check(lists.scene, frame, sound, lambda _: 1e-3) == count


# --- small things -------------------------------------------------------------------------------------------


def test_unknown_choices_are_refused() -> None:
    """Before anything is looked for."""
    unknown: Any = "vulkan"
    with pytest.raises(ValueError, match="`renderer` 'vulkan' is unknown"):
        Renderer(unknown)
    with pytest.raises(ValueError, match="`method` 'vulkan' is unknown"):
        Renderer("cpu", method=unknown)


def test_whatever_is_raised_is_one_line() -> None:
    """A short line; an error without text gives its kind; an error of ours passes."""
    for error, text in (
        (Exception("a\n  b\tc"), "a b c"),
        (KeyError(), "KeyError"),
        (RuntimeError("x" * 500), "x" * 197 + "..."),
        (GlError("GL_CONTEXT_LOST"), "GL_CONTEXT_LOST"),
    ):
        with pytest.raises(GlError) as caught, gl_errors():
            raise error
        assert str(caught.value) == text
    with pytest.raises(KeyboardInterrupt), gl_errors():
        raise KeyboardInterrupt


def test_shaders_include_each_other() -> None:
    """The version comes first, then the constants; no include is left."""
    text = gl.source("exact_fragment.glsl", 330, {"TEXTURE_WIDTH": 64})
    assert text.splitlines()[:2] == ["#version 330", "#define TEXTURE_WIDTH 64"]
    assert "ivec4 two_nearest(" in text
    assert "#include" not in text


def test_the_bound_of_float32() -> None:
    """It grows with the distance and with the block, not with the place."""
    frame = Frame(1e9 + 0j, 3 + 0j, 4j, 50, 50)
    assert float32_error(0.0, frame) == pytest.approx(16 * 2.0**-24 * 2 * 8 * 5)
    assert float32_error(100.0, frame) - float32_error(0.0, frame) == pytest.approx(16 * 2.0**-24 * 100)
    assert float32_error(7.0, frame.window(4, 5, 6, 7)) == float32_error(7.0, frame)


@pytest.mark.parametrize("sides", [0, 1, 3, 6, -4])
def test_cones_have_quarters(sides: int) -> None:
    """Meshes are the same on all sides of an element: other numbers of sides are refused."""
    with pytest.raises(ValueError, match="sides"):
        Renderer("cpu", method="hoff", sides=sides)


@pytest.mark.parametrize("wrong", [-1, 10**6])
def test_the_spot_check_looks_at_both_labels(wrong: int) -> None:
    """The label of the nearest other copy as well: of no copy, or of one that is farther."""
    frame = cell_frame(BIRD.lattice, 40)
    lists = lists_of(BIRD, frame)
    first, second, d1, d2 = cpu.render(lists, frame)
    error = Renderer("cpu").render(BIRD, frame).error
    render.spot_check(lists.scene, frame, (first, second, d1, d2), error)
    for images in ((first, np.full_like(second, wrong), d1, d2), (np.full_like(first, wrong), second, d1, d2)):
        with pytest.raises(GlError, match="labels of no copy"):
            render.spot_check(lists.scene, frame, images, error)
    for images in ((first, np.roll(second, 7, axis=0), d1, d2), (first, first, d1, d2)):
        with pytest.raises(GlError, match="wrong owner"):
            render.spot_check(lists.scene, frame, images, error)
