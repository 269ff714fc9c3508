"""Pytest plugin that logs what becomes of every test, an event a line, for tests/count: -p outcomes --outcomes FILE.

A JUnit file does not tell which tests were to run, nor that a worker died between two tests."""

import json

import pytest


def pytest_addoption(parser):
    parser.addoption("--outcomes", metavar="FILE", help="log what becomes of every test")


def pytest_configure(config):
    path = config.getoption("outcomes")
    if path and not hasattr(config, "workerinput"):  # workers report to the process that started them
        config.pluginmanager.register(Outcomes(path))


def reason_of(report):
    if hasattr(report, "wasxfail"):
        return f"expected to fail: {report.wasxfail}"
    if report.skipped:
        return str(report.longrepr[2]).removeprefix("Skipped: ")
    crash = getattr(report.longrepr, "reprcrash", None)
    lines = str(report.longrepr).splitlines()  # of a fixture or file that pytest cannot use, a worker that died
    return crash.message if crash else next((line[1:].strip() for line in lines if line.startswith("E ")), lines[-1])


class Outcomes:
    def __init__(self, path):
        self.file = open(path, "w", buffering=1)

    def write(self, **event):
        self.file.write(json.dumps(event) + "\n")

    def write_report(self, report, phase):
        reason = "" if report.passed else reason_of(report)
        self.write(test=report.nodeid, phase=phase, outcome=report.outcome, reason=reason)

    def pytest_collectreport(self, report):
        if not report.passed:
            self.write_report(report, "collection")

    def pytest_collection_finish(self, session):
        self.write(collected=[item.nodeid for item in session.items])

    @pytest.hookimpl(optionalhook=True)
    def pytest_xdist_node_collection_finished(self, ids):
        self.write(collected=list(ids))

    def pytest_runtest_logreport(self, report):
        self.write_report(report, report.when)

    @pytest.hookimpl(optionalhook=True)
    def pytest_testnodedown(self, node, error):
        if error:
            self.write(worker=node.gateway.id, reason=str(error))

    @pytest.hookimpl(trylast=True)
    def pytest_sessionfinish(self, exitstatus):
        self.write(end=int(exitstatus))
