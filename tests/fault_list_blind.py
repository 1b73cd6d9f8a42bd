"""Faults for `faults.py --blind`, by an author who had not seen the tests, at statements drawn with a seed.

The other list decides which tests run at every commit; this list judges that choice. Each fault is tried with all
tests.
"""

# ruff: noqa: E501 # what a fault does fits on a line better than on two
from fault_list import Fault

FAULTS_B = (
    # `pick` where no code fits says why, but no longer of which codes.
    Fault(
        name="pick-refusal-without-names",
        room="bench",
        kind="misleading message",
        old="        raise UsageError(reasons[0])\n    return fit, reasons\n",
        new="        raise UsageError(misfits[0][1])\n    return fit, reasons\n",
        tests="",
    ),
    # `render --specular-antialiasing on,off`: two steps have one key, so a resumed run takes one's rows for the other's.
    Fault(
        name="render-key-without-antialiasing",
        room="bench",
        kind="stale cache key",
        old='    key |= {"environment": case.environment_key, "specular_antialiasing": case.plan.antialiased}\n',
        new='    key |= {"environment": case.environment_key}\n',
        tests="",
    ),
    # A user's two functions of roughness that take a range besides are refused, though the message says they may.
    Fault(
        name="curve-shape-without-range",
        room="bench",
        kind="missing case",
        old='                (RANGE,),\n                "adapters/curve.glsl",\n',
        new='                (),\n                "adapters/curve.glsl",\n',
        tests="",
    ),
    # A user's code that is an integer of 24 used bits has 32 in the column `bits`, and is sorted among those of 32.
    Fault(
        name="packed-bits-of-storage",
        room="encodings",
        kind="wrong attribute",
        old="            return self.encoding.packed_bits\n        return sum(self.storage.bits[",
        new="            return sum(self.storage.bits)\n        return sum(self.storage.bits[",
        tests="",
    ),
    # C code that is written of a codec with step() gives 0 instead of 1 right at the edge.
    Fault(
        name="c-step-at-edge",
        room="bench",
        kind="wrong comparison",
        old='"{1} < {0} ? 0.0f : 1.0f"',
        new='"{1} <= {0} ? 0.0f : 1.0f"',
        tests="",
    ),
    # Times of `render` are those of a single frame where nobody asks for repeats.
    Fault(
        name="render-repeats-default",
        room="bench",
        kind="wrong default",
        old="    repeats: Repeats = 3\n",
        new="    repeats: Repeats = 1\n",
        tests="",
    ),
    # Errors in a user's WGSL name lines that are too small behind a comment of several lines.
    Fault(
        name="wgsl-comment-takes-lines",
        room="bench",
        kind="lost line feeds",
        old="        pieces += [text[place : match.start()], blank(text[match.start() : end])]\n",
        new='        pieces += [text[place : match.start()], " "]\n',
        tests="",
    ),
    # Numbers of targets with one channel are put in w instead of x: their code is said to differ from the renderer's.
    Fault(
        name="one-channel-target-in-w",
        room="bench",
        kind="wrong index",
        old='        texels[:, int(target), "xyzw".index(axis or "x")] = packed[:, column]\n',
        new='        texels[:, int(target), "xyzw".index(axis or "w")] = packed[:, column]\n',
        tests="",
    ),
    # `--effects gtao:slices=1000` ends in a traceback instead of the line with the values that are possible.
    Fault(
        name="effect-setting-out-of-range",
        room="gbuffer",
        kind="missing guard",
        old="            settings[name].read(text)\n",
        new="            type(settings[name].usual)(text)\n",
        tests="",
    ),
    # The GLSL of a layout stores negative light and NaN as they are in encodings that do not guard themselves.
    Fault(
        name="layout-light-unguarded",
        room="bench",
        kind="missing guard",
        old="_encode(light_or_none(vec4(s.{field.name}, 0.0)));",
        new="_encode(vec4(s.{field.name}, 0.0));",
        tests="",
    ),
    # Of an image of several parts only the channels of the first are known: the others' names are refused.
    Fault(
        name="first-part-of-header-alone",
        room="bench",
        kind="missing case",
        old='        out.write_text(json.dumps(named_parts), encoding="utf-8", newline="\\n")\n',
        new='        out.write_text(json.dumps(named_parts[:1]), encoding="utf-8", newline="\\n")\n',
        tests="",
    ),
    # A gate's second limit may name no column or no figure: it is not refused with the known figures.
    Fault(
        name="first-limit-checked-alone",
        room="bench",
        kind="missing case",
        old="        for limit in limits:\n            limit.check(table)\n",
        new="        for limit in limits[:1]:\n            limit.check(table)\n",
        tests="",
    ),
    # `history` never finds a step in the times of a table that has one column of times alone.
    Fault(
        name="history-one-time-is-none",
        room="bench",
        kind="off by one",
        old="        return bool(self.table.of_role(Role.TIME))\n",
        new="        return len(self.table.of_role(Role.TIME)) > 1\n",
        tests="",
    ),
    # The column limit_rms_deg of `quality` has the least mean angle, at odds with the share that is reached.
    Fault(
        name="rms-limit-is-mean",
        room="bench",
        kind="wrong attribute",
        old='    least = code_limit(codec.codes, AREAS[domain])\n    row: Row = {"limit_mean_deg": least.mean_deg, "limit_rms_deg": least.rms_deg,',
        new='    least = code_limit(codec.codes, AREAS[domain])\n    row: Row = {"limit_mean_deg": least.mean_deg, "limit_rms_deg": least.mean_deg,',
        tests="",
    ),
    # A report in Markdown runs its paragraphs together: no empty line stands between remarks, answers and tables.
    Fault(
        name="markdown-blocks-run-together",
        room="reports",
        kind="missing separator",
        old='        text += block + "\\n"\n',
        new="        text += block\n",
        tests="",
    ),
    # The process that runs a user's code keeps variables such as PYPI_TOKEN, which it was to be rid of.
    Fault(
        name="secrets-kept-by-prefix",
        room="bench",
        kind="wrong constant",
        old='        if name not in VARIABLES and not name.startswith("PYTHON"):\n',
        new='        if name not in VARIABLES and not name.startswith("PY"):\n',
        tests="",
    ),
    # Code that divides 0 by a number is said to do what its language leaves undefined; code that divides by 0 is not.
    Fault(
        name="division-noted-with-sides-swapped",
        room="bench",
        kind="swapped argument",
        old="            new_words += _written(CALL, (result, next(numbers), note, x, y))\n",
        new="            new_words += _written(CALL, (result, next(numbers), note, y, x))\n",
        tests="",
    ),
    # Rows of `cost` on NVIDIA lack the columns of kinds of which a kernel has no instruction, where there was a 0.
    Fault(
        name="sass-kinds-without-zeros",
        room="bench",
        kind="missing case",
        old="    return {kind: counts[kind] for kind in KINDS}\n\n\ndef issue_slots(_: Mapping[str, int], __: str) -> None:\n",
        new="    return dict(counts)\n\n\ndef issue_slots(_: Mapping[str, int], __: str) -> None:\n",
        tests="",
    ),
    # Plots with dotted and solid lines name the ends of the dotted ones alone.
    Fault(
        name="ends-of-first-mark-alone",
        room="reports",
        kind="missing case",
        old="    return [(mark, row) for mark in ends for row in part.lasts(mark)]\n",
        new="    return [(mark, row) for mark in ends[:1] for row in part.lasts(mark)]\n",
        tests="",
    ),
    # `pick` says of each code that qualifies that it is the best, the most exact and all else at once.
    Fault(
        name="places-share-a-list",
        room="bench",
        kind="aliased list",
        old="    places: list[list[str]] = [[] for _ in fit]\n",
        new="    places: list[list[str]] = [[]] * len(fit)\n",
        tests="",
    ),
    # Light propagation volumes in rgba16f are kept in 32 bits: their rows show no loss, and they take twice the memory.
    Fault(
        name="half-volumes-in-full",
        room="gbuffer",
        kind="wrong constant",
        old='"float": {11: "f2", 16: "f2", 32: "f4"}',
        new='"float": {11: "f2", 16: "f4", 32: "f4"}',
        tests="",
    ),
    # A mesh file of which one mesh has no normals is refused as if none had: the others are not measured.
    Fault(
        name="meshes-all-or-nothing",
        room="bench",
        kind="wrong condition",
        old="    meshes = [mesh for mesh in all_meshes if mesh.normals is not None]\n    if not meshes:\n",
        new="    meshes = all_meshes if all(mesh.normals is not None for mesh in all_meshes) else []\n    if not meshes:\n",
        tests="",
    ),
    # Figures stay open after they are saved: memory grows with each plot, and matplotlib warns from the 21st on.
    Fault(
        name="figures-stay-open",
        room="reports",
        kind="forgotten cleanup",
        old="        pyplot.close(figure)\n",
        new="        figure.clear()\n",
        tests="",
    ),
    # A loop of WGSL with break and continuing is refused, as one with continue is; so is a case with continue.
    Fault(
        name="any-leave-refused",
        room="bench",
        kind="missing condition",
        old="            case Leave(said) if said == word:\n                return True\n",
        new="            case Leave():\n                return True\n",
        tests="",
    ),
    # After a damaged PNG of 16 bits in a model, the image library prints a stray complaint when the command ends.
    Fault(
        name="library-error-not-taken",
        room="gbuffer",
        kind="forgotten cleanup",
        old="    if pixels is None:\n        oiio.geterror()  # else the library prints it at exit\n        raise PictureError(DAMAGED)\n",
        new="    if pixels is None:\n        raise PictureError(DAMAGED)\n",
        tests="",
    ),
    # A captured frame whose images are NaN only where nothing is drawn is refused, and a mask does not help.
    Fault(
        name="background-must-be-finite",
        room="bench",
        kind="wrong argument",
        old="        _check_finite(path, pixels.planes, covered)\n",
        new="        _check_finite(path, pixels.planes, np.ones_like(covered))\n",
        tests="",
    ),
    # `#if NAME` of an empty macro ends in a traceback; of another one the message names its value instead of it.
    Fault(
        name="not-whole-number-names-value",
        room="bench",
        kind="wrong variable in message",
        old='            raise TranslationError(f"{line}:1: {token.text} is not a whole number")\n',
        new='            raise TranslationError(f"{line}:1: {stands[0].text} is not a whole number")\n',
        tests="",
    ),
    # Whoever adds an encoding under another name is told the wrong way round which of the two names is to be changed.
    Fault(
        name="encoding-name-message-swapped",
        room="encodings",
        kind="swapped argument in message",
        old='ENCODING has the name {encoding.name!r} instead of {name!r}")',
        new='ENCODING has the name {name!r} instead of {encoding.name!r}")',
        tests="",
    ),
    # `depth --distance` refuses the distance of the far plane itself.
    Fault(
        name="distance-at-far-refused",
        room="bench",
        kind="wrong comparison",
        old="        if not camera.near <= distance <= camera.far:\n",
        new="        if not camera.near <= distance < camera.far:\n",
        tests="",
    ),
    # The message about a glTF file that is cut off says that a view holds as many bytes as the whole buffer.
    Fault(
        name="cut-off-view-left",
        room="gbuffer",
        kind="wrong figure in message",
        old="            left = max(len(data) - offset, 0)\n",
        new="            left = len(data)\n",
        tests="",
    ),
    # The table that `render` prints has the column `invalid`, which is not for people.
    Fault(
        name="render-shows-hidden-columns",
        room="bench",
        kind="missing step",
        old="    rows = without(TABLE.without_hidden(done.rows), _usual_columns(done.rows))\n",
        new="    rows = without(done.rows, _usual_columns(done.rows))\n",
        tests="",
    ),
    # `history` names a run next to the one at which times stepped, where the step by ranks is off by some.
    Fault(
        name="steps-not-placed",
        room="bench",
        kind="wrong variable",
        old="    return placed[1:-1]\n",
        new="    return [*begins]\n",
        tests="",
    ),
    # Of a user's code with numbers of 16 bits the note says that it is computed in 32 where it has rows in half, too.
    Fault(
        name="half-note-reversed",
        room="bench",
        kind="inverted condition",
        old="{DECLARES_HALF if encoding.is_also_half else IN_32_BITS}",
        new="{IN_32_BITS if encoding.is_also_half else DECLARES_HALF}",
        tests="",
    ),
    # What is not as in the file about a glTF file's lights, such as further suns that are not drawn, is not said.
    Fault(
        name="notes-before-lights",
        room="gbuffer",
        kind="wrong order",
        old="    lights = lights_of(gltf, nodes, kept, notes)\n    unique_notes = tuple(dict.fromkeys([*notes, *read.notes]))\n",
        new="    unique_notes = tuple(dict.fromkeys([*notes, *read.notes]))\n    lights = lights_of(gltf, nodes, kept, notes)\n",
        tests="",
    ),
    # Pieces of a model that are stretched along an axis count as rigid: they are drawn with wrong normals.
    Fault(
        name="stretched-pieces-are-rigid",
        room="gbuffer",
        kind="wrong normalisation",
        old="        square = linear @ linear.T\n",
        new="        square = (axes := linear / np.linalg.norm(linear, axis=0)) @ axes.T\n",
        tests="",
    ),
    # The table of `vectors` for codes that lose motions has all codes in it, if one loses any.
    Fault(
        name="losing-codes-not-picked",
        room="bench",
        kind="wrong variable",
        old="_by_speed(part, figure, (*names, *more))",
        new="_by_speed(rows, figure, (*names, *more))",
        tests="",
    ),
    # `--seed` changes nothing about uniform directions: rows of two seeds have the same figures.
    Fault(
        name="uniform-ignores-seed",
        room="bench",
        kind="wrong argument",
        old="    offsets = np.random.default_rng(seed).integers(0, 2**32, 2, dtype=np.uint32)\n",
        new="    offsets = np.random.default_rng(count).integers(0, 2**32, 2, dtype=np.uint32)\n",
        tests="",
    ),
    # A file of `--live` with a code whose largest error is beyond 90 degrees is taken for no such file.
    Fault(
        name="live-errors-to-ninety",
        room="bench",
        kind="wrong limit",
        old="Degrees = Annotated[float, Field(ge=0, le=180)]\n",
        new="Degrees = Annotated[float, Field(ge=0, le=90)]\n",
        tests="",
    ),
    # A spot that shines straight down has a shadow camera of NaN: its light does not propagate.
    Fault(
        name="spot-sight-without-up",
        room="gbuffer",
        kind="missing argument",
        old="tuple((np.array(spot.position) + way).tolist()), 90.0, 1.0, 2.0, up)\n",
        new="tuple((np.array(spot.position) + way).tolist()), 90.0, 1.0, 2.0)\n",
        tests="",
    ),
    # The article's error of codes that decode to the other side is too large: differences above 1 are not cut off.
    Fault(
        name="article-error-unclamped",
        room="bench",
        kind="missing clamp",
        old="jnp.round(minimum(abs(c), 1.0) * 255.0)",
        new="jnp.round(abs(c) * 255.0)",
        tests="",
    ),
)
