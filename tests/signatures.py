"""Writes what the zoo's pictures of the homework's scene look like: `python tests/signatures.py`.

Into lessons/zoo/cornell.npz, with seed and commit. Minutes; what is done is kept in .doctor/ as long as
the commit is the same.
"""

import sys

import numpy as np
from accuracy import commit
from doctor_paper import KEPT

import tracer
from lessons.zoo import ZOO
from lessons.zoo.pictures import RIGHTS, SEED, SIDE, SPP, TABLE, looks
from tracer.doctor import examine
from tracer.trace import gather

COLUMNS = ("mean", "error", "bright", "bright_error", "texture")


def of(bug, scene, spp=SPP):
    """What the table holds of one bug, as arrays by name."""
    seen, picture = looks(scene, bug, SIDE, spp)
    levels = [seen.at[n] for n in sorted(seen.at)]
    found = {name: np.array([getattr(level, name) for level in levels], np.float16) for name in COLUMNS}
    return found | {
        "spp": np.array(sorted(seen.at)),
        "picture": picture.astype(np.float16),
        "rule": rule(bug, scene),
    }


def rule(bug, scene):
    """Id of the law that a trace of this bug breaks first; "" where none does."""
    trace = gather(scene, bug.asked(width=24, height=24, spp=8), bug.steps)
    causes = examine(trace).causes
    return np.array(causes[0].rule if causes else "")


def main():
    scene = tracer.load("cornell")
    homework = [bug for bug in ZOO.values() if bug.scene == "cornell" and not bug.only_cost]
    folder = KEPT / f"signatures-{commit()}"
    folder.mkdir(parents=True, exist_ok=True)
    rows = []
    for bug in (*RIGHTS, *homework):
        file = folder / f"{bug.id}.npz"
        if not file.exists():
            np.savez(file.with_suffix(".part.npz"), **of(bug, scene))
            file.with_suffix(".part.npz").replace(file)
            print(bug.id, flush=True)
        with np.load(file) as kept:
            rows.append({name: kept[name] for name in kept.files})
    table = {name: np.stack([row[name] for row in rows]) for name in COLUMNS}
    ids = [bug.id for bug in (*RIGHTS, *homework)]
    rules = [str(row["rule"]) for row in rows]
    np.savez_compressed(
        TABLE,
        ids=ids,
        rules=rules,
        spp=rows[0]["spp"],
        picture=rows[0]["picture"],
        seed=SEED,
        commit=commit(),
        **table,
    )


if __name__ == "__main__":
    try:
        main()
    except KeyboardInterrupt:
        sys.exit("stopped; what is done is kept")
