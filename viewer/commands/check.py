"""The command `castray check`."""

from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

from tracer.picture import check_place, write_whole
from tracer.settings import TracerError
from viewer.options import CheckOptions, Json, check_no_tracer, print_json
from viewer.words import Speaker


def check(
    file: Path,
    /,
    *,
    scene: str = "cornell",
    new: Annotated[bool, Parameter(negative=())] = False,
    seconds: float = 300.0,
    csv: Path | None = None,
    html: Path | None = None,
    options: CheckOptions | None = None,
    json: Json = False,
):
    """Run your own cast_ray and hold the laws of light transport against what it did.

    Exit code 0 if nothing is found, 1 if something is. Of a folder every tracer (.py), log (.jsonl) and
    picture is judged, and what cannot be judged counts as found; hypotheses from pictures do not.

    Parameters
    ----------
    file
        A Python file with a function cast_ray(scene, ray, depth), or a folder of submissions.
    scene
        What it is asked to trace: a scene file, or the bare name of one that comes with castray.
    new
        Write a tracer to start from into that file, and do no more.
    seconds
        Most time that each may take.
    csv
        Of a folder: where the table goes for spreadsheets.
    html
        Of a folder: where the table goes as a page that needs nothing else, with what proves each finding.
    """
    if new:
        _write_starter(file)
        return 0
    if not 0.0 < seconds < float("inf"):
        raise TracerError(f"seconds: {seconds} is not a time")
    if file.suffix.lower() != ".py":
        check_no_tracer(str(file))
    if file.is_dir():
        return _folder(file, scene, seconds, csv, html, options, json)
    if csv is not None or html is not None:
        raise TracerError(f"--{'csv' if csv is not None else 'html'}: is for a folder; {file} is none")
    from lessons.course import about
    from viewer.checking.learner import examined

    diagnosis, trace = examined(file, scene, options, seconds)
    diagnosis = diagnosis.explained_by(about)
    if json:
        print_json(diagnosis.as_dict())
    else:
        from viewer.doctor_report import print_diagnosis

        print_diagnosis(diagnosis, trace)
    return 1 if diagnosis.findings else 0


def _folder(folder, scene, seconds, csv, html, options, json):
    """Every submission of a folder: a row each."""
    from tracer import load
    from viewer.checking import report
    from viewer.checking.limited import Judge
    from viewer.checking.submission import FAILED, WRONG, files_in
    from viewer.progress import watched

    for place in filter(None, (csv, html)):
        check_place(place)
    say, files, rows = Speaker(), files_in(folder), []
    load(scene)  # what is wrong with it is said once
    with watched(say("check.judging")) as progress, Judge(scene, options, seconds) as judge:
        for done, (path, name) in enumerate(files):
            rows.append(judge.row(path, name))
            if progress:
                progress(done + 1, len(files))
    if csv is not None:
        _write(csv, report.as_csv(rows, say))
    if html is not None:
        _write(html, report.as_html(rows, folder, scene, say))
    if json:
        print_json(report.as_dict(rows, folder, scene, say))
    else:
        report.print_rows(rows, say)
        if csv is not None or html is not None:
            print("\n" + say("check.written", files=say.listed(*map(str, filter(None, (csv, html))))))
    return 1 if any(row.state in (WRONG, FAILED) for row in rows) else 0


def _write(place, text):
    write_whole(place, lambda beside: Path(beside).write_text(text, encoding="utf-8", newline=""))


def _write_starter(file):
    from tracer.learner import starter

    if file.exists():
        raise TracerError(f"{file}: is there already; choose another name")
    try:
        file.write_text(Path(starter.__file__).read_text(encoding="utf-8"), encoding="utf-8")
    except OSError as error:
        raise TracerError(f"{file}: {error.strerror}") from None
    print(Speaker()("told.starter", file=file))
