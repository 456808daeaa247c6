"""Device and tracker discovery with prostm devices, and the arrays that devices imply."""

import json
import socket
import threading
import time

import pytest

from conftest import free_port


def rows_of(prostm, *names, status=0):
    return json.loads(prostm("devices", *names, "--json", "-", status=status).stdout)


def test_looks_for_everything_and_prints_at_most_100_columns(prostm):
    start = time.monotonic()
    lines = prostm("devices").stdout.splitlines()
    assert time.monotonic() - start < 10, "looks are bounded, and go side by side"
    assert all(len(line) <= 100 for line in lines), max(lines, key=len)
    rows = rows_of(prostm)
    assert {row["role"] for row in rows} == {"array", "hand", "system"}
    kinds = {row["kind"]: row for row in rows}
    assert kinds["sim"]["found"] is None and kinds["sim"]["available"]
    assert kinds["leap"]["found"] in (True, False) and "127.0.0.1:6437" in kinds["leap"]["words"]
    assert {"priority", "memory", "ipv6"} <= set(kinds)
    firsts = [line for line in lines if not line.startswith(" ")]
    assert len(firsts) == len(rows)
    for row, line in zip(rows, firsts):
        assert line.split()[:2] == [row["role"], row["kind"]]


def test_looks_only_for_the_named_devices(prostm):
    (row,) = rows_of(prostm, f"leap://127.0.0.1:{free_port()}", status=1)
    assert row["found"] is False and "nothing answers" in row["words"]
    assert "UltraleapTrackingWebSocket" in row["words"]
    (row,) = rows_of(prostm, "sim")
    assert row["kind"] == "sim" and row["found"] is None


def test_a_program_with_another_protocol_is_not_a_tracker(prostm):
    with socket.create_server(("127.0.0.1", 0)) as server:

        def answer():
            connection, _ = server.accept()
            with connection:
                connection.recv(4096)
                connection.sendall(b"HTTP/1.1 404 Not Found\r\nContent-Length: 0\r\n\r\n")

        thread = threading.Thread(target=answer)
        thread.start()
        (row,) = rows_of(prostm, f"leap://127.0.0.1:{server.getsockname()[1]}", status=1)
        thread.join()
    assert row["found"] is False and "does not serve /v6.json" in row["words"]


def test_a_program_that_accepts_without_an_answer_times_out(prostm):
    with socket.create_server(("127.0.0.1", 0)) as server:
        start = time.monotonic()
        (row,) = rows_of(prostm, f"leap://127.0.0.1:{server.getsockname()[1]}", status=1)
        assert time.monotonic() - start < 5
    assert row["found"] is False


@pytest.mark.parametrize("name, words", [
    ("toaster", ["device 'toaster' is unknown"]),
    ("sim://127.0.0.1:80", ["sim", "no address"]),
    ("leap://127.0.0.1:many", ["port", "1 to 65535"]),
])
def test_unknown_names_are_rejected_before_any_search(refuses, name, words):
    refuses("devices", "leap://127.0.0.1:1", name, words=words)


def test_the_system_row_of_a_limit_explains_what_to_do(prostm):
    for row in rows_of(prostm):
        if row["role"] == "system" and not row["available"]:
            assert "limits.d" in row["detail"] or "IPv6" in row["detail"]


def test_the_help_of_device_lists_names_and_addresses(prostm):
    text = " ".join(prostm("run", "--help").stdout.split())
    for row in rows_of(prostm):
        if row["role"] == "array" and row["available"]:
            form = row["detail"].split("--device ")[1].split(": ")[0]
            assert form in text


def test_a_device_implies_its_array_and_rejects_another(prostm, refuses):
    """Kinds that imply an array are only listed in builds that include them."""
    implied = [row for row in rows_of(prostm) if row["role"] == "array" and row["available"] and row["array"]]
    if not implied:
        pytest.skip("no device that is built implies an array")
    for row in implied:
        other = "usx" if row["array"] != "usx" else "autd3"
        refuses("run", "--device", row["kind"], "--array", other, words=["contradicts", row["array"]])


def test_a_real_time_device_rejects_stepped_runs(prostm, refuses):
    clocked = [row for row in rows_of(prostm) if row["role"] == "array" and row["available"] and row["kind"] != "sim"]
    if not clocked:
        pytest.skip("no device but the simulated one is built")
    for row in clocked:
        for mode in ("--stepped", "--as-fast-as-possible"):
            refuses("run", "--device", row["kind"], mode, words=["keeps its own time", "--stepped"])


def test_a_run_reports_whether_its_memory_is_locked(prostm):
    text = prostm("run", "--grid", "32", "--seconds", "0.2", "--lock-memory").stdout
    assert "All memory is locked" in text or "Memory may not be locked" in text
    assert "Real-time priority is" in text
