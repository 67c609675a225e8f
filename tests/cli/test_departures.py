"""`gcs-windplan departures`: when to fly."""

from __future__ import annotations

import json
from datetime import datetime, timedelta
from pathlib import Path

import pytest
from typer.testing import CliRunner

from gcs_windplan.cli.app import app
from gcs_windplan.errors import InputError

FRONT = Path(__file__).resolve().parents[2] / "missions" / "front.yaml"


def run(*words: str):
    return CliRunner().invoke(app, ["departures", str(FRONT), *words])


def rows(*words: str) -> list[dict]:
    result = run(*words, "--json", "--cores", "1")
    found = json.loads(result.stdout)["departures"]
    assert result.exit_code == (0 if any(row["feasible"] for row in found) else 1), result.output
    return found


def test_it_tells_when_to_fly():
    found = rows("--from", "08:00", "--to", "18:00", "--every", "5h")
    assert [row["departure"] for row in found] == [f"2026-05-01T{hour:02d}:00:00+00:00" for hour in (8, 13, 18)]
    morning, noon, evening = found
    assert morning["seconds"] < noon["seconds"] < evening["seconds"]
    assert [row["feasible"] for row in found] == [True, False, False]
    assert noon["reason"].endswith(" of 499 Wh")  # the battery's reserve is broken
    assert evening["reason"] == f"{10 - evening['member_seconds'].count(None)}/10 members"
    assert all(len(row["member_seconds"]) == 10 for row in found)
    assert None not in morning["member_seconds"]
    assert None in evening["member_seconds"]  # too strong in some members
    assert morning["energy"] < noon["energy"]
    assert all(row["strongest_gust"] > row["strongest_wind"] > 5.0 for row in found)


def test_the_table_marks_the_quickest_and_says_what_it_took():
    result = run("--from", "08:00", "--to", "13:00", "--every", "5h", "--cores", "2")
    assert result.exit_code == 0, result.output
    best = [line for line in result.stdout.splitlines() if "best" in line]
    assert len(best) == 1
    assert "05-01 08:00" in best[0]
    assert "10/10" in best[0]
    assert "2 departures x 10 members in" in result.stdout
    assert "on 2 cores" in result.stdout


def test_a_time_of_day_before_the_first_one_is_on_the_next_day():
    found = rows("--from", "23:00", "--to", "01:00", "--every", "2h")
    assert [row["departure"][:13] for row in found] == ["2026-05-01T23", "2026-05-02T01"]


def test_a_departure_at_which_nothing_can_be_flown_says_why():
    found = rows("--from", "2026-05-01T16:00Z", "--to", "2026-05-01T16:00Z", "--airspeed", "9")
    (row,) = found
    assert not row["feasible"]
    assert row["seconds"] is None
    assert "wind" in row["reason"]


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (("--from", "six", "--to", "18:00"), "--from: 'six' is not a date and time"),
        (("--from", "06:00", "--to", "18:00", "--every", "soon"), "--every: 'soon' is no step"),
        (("--from", "06:00", "--to", "18:00", "--every", "1s"), "at most 2000"),
        (("--from", "2026-05-01T12:00Z", "--to", "2026-05-01T06:00Z"), "lies before --from"),
        (("--from", "2026-05-03T12:00Z", "--to", "2026-05-03T18:00Z"), "outside of its times"),
        (("--from", "2026-05-01T12:00", "--to", "18:00"), "offset from UTC is missing"),
    ],
)
def test_bad_times_are_one_clear_error(words, message):
    with pytest.raises(InputError) as error:
        CliRunner().invoke(app, ["departures", str(FRONT), *words], catch_exceptions=False)
    assert message in str(error.value)


def test_what_the_workers_find_is_what_one_core_finds():
    from gcs_windplan.jobs.requests import read_request
    from gcs_windplan.planning.departures import moments_between, sweep

    first = datetime.fromisoformat("2026-05-01T07:00Z")
    moments = moments_between(first, first + timedelta(hours=2), timedelta(hours=1))
    request = read_request(FRONT, first, 12 * 3600.0)
    alone, together = (list(sweep(request, moments, cores=cores)) for cores in (1, 2))
    assert [one.moment for one in together] == moments
    assert [one.seconds for one in alone] == pytest.approx([one.seconds for one in together], rel=1e-9)
    assert [one.spread for one in alone] == [one.spread for one in together]
