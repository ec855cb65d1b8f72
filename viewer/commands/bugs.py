"""The command `castray bugs`."""

from viewer.options import Json, print_json


def bugs(*, json: Json = False):
    """List the bug zoo: what each bug looks like, and which law it breaks."""
    from lessons.zoo import ZOO

    if json:
        print_json(
            [
                {"id": bug.id, "title": bug.title, "symptom": bug.symptom, "law": bug.law}
                for bug in ZOO.values()
            ]
        )
        return
    from viewer.report import print_bugs

    print_bugs(ZOO.values())
