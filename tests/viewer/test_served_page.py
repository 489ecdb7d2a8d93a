"""The page of ``ncsim view --serve``: runs, studies, and a form that makes runs."""

import os
import re
import shutil
import subprocess
import sys
import threading
from pathlib import Path

import pytest
from ncsim_core.cli.main import main as ncsim
from ncsim_viz.server.child import Limits
from ncsim_viz.server.serving import ViewerServer

ROOT = Path(__file__).parents[2]
SWEEP = """
sweep:
  name: small
  base:
    network: {type: paper_grid, size: 2}
    dags: {type: paper, tasks: 5}
    config: {link_model: wifi, routing: widest_path}
  vary:
    dags.tasks: [5, 10]
    scheduler: [heft, round_robin]
    interference: [none, csma_bianchi]
"""


@pytest.fixture
def served(tmp_path, grid_runs):
    for folder in grid_runs:
        shutil.copytree(folder, tmp_path / "served" / folder.name.rstrip("0"))
    with ViewerServer(tmp_path / "served", limits=Limits(60.0, 4000, 100)) as server:
        thread = threading.Thread(target=server.serve_forever, kwargs={"poll_interval": 0.02})
        thread.start()
        yield server
        server.shutdown()
        thread.join()


def run_rows(page):
    return page.locator("table:has(caption:text-is('Runs')) tbody tr")


def test_the_runs_of_the_folder_are_listed_opened_and_compared(served, open_page, until):
    page = open_page(served.url)
    page.get_by_role("button", name="full", exact=True).click()
    until(page, "ncsimViewer.run.done !== null")

    assert page.locator("header .status").inner_text() == "completed"
    page.keyboard.press("r")
    page.get_by_role("button", name="with full").click()
    until(page, "ncsimViewer.page.source.other !== null")
    assert page.locator("nav button[aria-current=page]").inner_text() == "8 Compare"
    until(page, "location.hash.includes('b=solo')")  # the address follows a moment later
    address = page.url
    page.reload()
    until(page, "window.ncsimViewer && ncsimViewer.page.source.other !== null")
    assert "p=full" in address
    assert "b=solo" in address


@pytest.fixture(scope="session")
def made_study(tmp_path_factory):
    folder = tmp_path_factory.mktemp("sweep")
    (folder / "sweep.yaml").write_text(SWEEP)
    with pytest.raises(SystemExit) as ended:
        ncsim(["sweep", str(folder / "sweep.yaml"), "-o", str(folder / "study"), "-q", "-j", "1"])
    assert ended.value.code == 0
    return folder / "study"


@pytest.fixture
def study(served, made_study):
    """The study among what is served."""
    return shutil.copytree(made_study, served.site.library.root / "study")


@pytest.mark.usefixtures("study")
def test_a_study_shows_winners_regret_maps_and_runs_again_what_is_chosen(served, open_page, until):
    page = open_page(served.url)
    page.get_by_role("button", name="study", exact=True).click()
    until(page, "ncsimViewer.page.source.extras.study")

    for name in ("Winners", "Regret", "Heat map", "Curves"):
        page.get_by_role("button", name=name, exact=True).click()
        assert page.evaluate("ncsimViewer.svg('sweep')").count("<text") >= 8, name
    page.get_by_role("button", name="Runs", exact=True).click()
    assert page.locator(".rows tbody tr:not(.gap)").count() == 8
    page.locator(".rows tbody button").first.click()
    page.get_by_role("button", name="Run it again and open").click()
    until(page, "ncsimViewer.run.done !== null", timeout_s=30)
    row = page.evaluate("ncsimViewer.page.source.extras.study.runs.rows[0]")
    columns = page.evaluate("ncsimViewer.page.source.extras.study.runs.columns")
    makespan_us = page.evaluate("ncsimViewer.run.done.makespan")
    assert makespan_us / 1e6 == pytest.approx(row[columns.index("makespan_s")])


@pytest.mark.usefixtures("study")
@pytest.mark.parametrize("theme", ["light", "dark"])
def test_axe_finds_nothing_serious_in_form_runs_and_studies(
    served, open_page, until, serious_findings, theme
):
    page = open_page(served.url, color_scheme=theme)
    page.get_by_role("button", name="study", exact=True).wait_for()
    found = {"runs": serious_findings(page)}
    page.keyboard.press("n")
    page.locator(".run-box [role=status]:has-text('valid')").wait_for()
    page.locator("#yaml").fill(yaml_of(page).replace("to: relay", "to: relai"))
    page.locator(".faults button").first.wait_for()
    found["form"] = serious_findings(page)
    page.evaluate("ncsimViewer.service.openStudy('study')")
    until(page, "ncsimViewer.page.source.extras.study !== undefined")
    for sheet in range(5):
        page.evaluate("sheet => ncsimViewer.page.store.set({sheet})", sheet)
        found[sheet] = serious_findings(page)

    assert {place: findings for place, findings in found.items() if findings} == {}


def yaml_of(page):
    return page.locator("#yaml").input_value()


@pytest.fixture
def form(served, open_page):
    page = open_page(served.url + "#v=configure")
    page.locator(".run-box [role=status]:has-text('valid')").wait_for()
    return page


def test_form_and_yaml_follow_each_other(form, until):
    form.get_by_label("seed").fill("7")
    form.get_by_label("seed").press("Tab")
    until(form, "document.querySelector('#yaml').value.includes('seed: 7')")
    form.locator("#yaml").fill(yaml_of(form).replace("seed: 7", "seed: 8"))
    until(form, "document.querySelector('[data-pointer$=\"/seed\"]').value === '8'")
    form.get_by_label("seed").fill("")
    form.get_by_label("seed").press("Tab")

    until(form, "!document.querySelector('#yaml').value.includes('seed')")


def test_what_is_being_typed_survives_an_answer_of_the_server(form, until):
    form.get_by_label("seed").fill("77")  # typed, not yet left
    form.evaluate(
        "() => { const yaml = document.querySelector('#yaml'); yaml.value += '# later\\n';"
        " yaml.dispatchEvent(new Event('input', {bubbles: true})); }"
    )
    form.wait_for_timeout(1500)

    assert form.get_by_label("seed").input_value() == "77"
    form.get_by_label("seed").press("Tab")
    until(form, "document.querySelector('#yaml').value.includes('seed: 77')")


def test_options_appear_with_the_component_that_has_them(form, until):
    form.get_by_label("link model").select_option("wifi")
    form.get_by_label("rate", exact=True).select_option("raw_phy")
    until(form, "document.querySelector('#yaml').value.includes('raw_phy')")

    assert re.search(r"link_model:\s+type: wifi\s+options: {rate: raw_phy}", yaml_of(form))
    form.get_by_label("rate", exact=True).select_option("")
    until(form, "/link_model: wifi/.test(document.querySelector('#yaml').value)")


def test_cells_of_a_spreadsheet_are_pasted_into_a_table(form, until):
    form.evaluate(
        """() => { const cell = document.querySelector('[data-pointer="/scenario/network/nodes/2/id"]');
        const data = new DataTransfer(); data.setData('text/plain', 'x\\t5\\ny\\t6\\t1\\t2\\n');
        data.setData('text', 'x\\t5\\ny\\t6\\t1\\t2\\n');
        cell.dispatchEvent(new ClipboardEvent('paste', {clipboardData: data, bubbles: true, cancelable: true})); }"""  # noqa: E501
    )
    until(form, "document.querySelector('#yaml').value.includes('id: y')")

    nodes = form.get_by_role("region", name="nodes").locator("tbody tr")
    assert nodes.count() == 4
    assert [
        nodes.nth(3).locator("input").nth(i).input_value() for i in range(4)
    ] == ["y", "6", "1", "2"]  # fmt: skip


def test_a_fault_stands_at_its_field_and_the_list_leads_there(form):
    form.locator("#yaml").fill(yaml_of(form).replace("to: relay", "to: relai"))
    form.locator(".faults button").first.wait_for()

    assert form.get_by_role("button", name="Run", exact=True).is_disabled()
    form.locator(".faults button").first.click()
    focused = form.evaluate("document.activeElement.dataset.pointer")
    assert focused == "/scenario/network/links/0/to"
    assert form.evaluate("document.activeElement.getAttribute('aria-invalid')") == "true"
    assert "relay" in form.locator(".faults li").first.inner_text()  # did you mean


def test_a_preset_is_made_run_and_opened(form, until):
    form.get_by_text("Presets: make a network").click()
    form.get_by_role("button", name="Replace network and workflows").click()
    until(
        form,
        "!document.querySelector('#yaml').value.includes('sensor') && "
        "/valid|fault/.test(document.querySelector('.run-box [role=status]').textContent)",
    )
    form.get_by_label("link model").select_option("wifi")
    form.get_by_label("scheduler", exact=True).select_option("heft")
    form.locator(".run-box [role=status]:text-matches('^valid')").wait_for()
    form.get_by_label("Run name").fill("from-page")
    form.get_by_role("button", name="Run", exact=True).click()
    form.get_by_role("row", name=re.compile("from-page completed")).wait_for(timeout=30_000)
    form.get_by_role("button", name="Open", exact=True).click()

    until(form, "ncsimViewer.run.done !== null")
    assert form.evaluate("ncsimViewer.run.status") == "completed"


def test_runs_that_go_on_or_wait_are_cancelled_from_the_page(form, served, tmp_path, monkeypatch):
    (tmp_path / "endless.py").write_text("import time\n\ndef run():\n    time.sleep(60)\n")
    monkeypatch.setenv("PYTHONPATH", str(tmp_path))
    monkeypatch.setattr("ncsim_viz.server.jobs.ENTRY", "endless:run")
    for name in ("goes-on", "waits"):
        form.get_by_label("Run name").fill(name)
        form.get_by_role("button", name="Run", exact=True).click()
        form.get_by_role("row", name=re.compile(f"{name} (running|queued)")).wait_for()
    for name in ("waits", "goes-on"):
        row = form.get_by_role("row", name=re.compile(f"^{name} "))
        row.get_by_role("button", name="Cancel").click()
        form.get_by_role("row", name=re.compile(f"{name} cancelled")).wait_for()

    assert form.get_by_role("button", name="Cancel").count() == 0
    assert {each.name for each in served.site.library.root.iterdir()} == {"full", "solo"}


def test_options_of_a_third_party_plugin_appear_with_no_change_to_the_page(
    tmp_path, open_page, until
):
    site = tmp_path / "site"
    shutil.copytree(ROOT / "examples/third-party/src/ncsim_lookahead", site / "ncsim_lookahead")
    about = site / "ncsim_lookahead-0.1.0.dist-info"
    about.mkdir()
    (about / "METADATA").write_text(
        "Metadata-Version: 2.1\nName: ncsim-lookahead\nVersion: 0.1.0\n"
    )
    (about / "entry_points.txt").write_text(
        "[ncsim.plugins]\nncsim-lookahead = ncsim_lookahead.declaration\n"
    )
    (tmp_path / "served").mkdir()
    command = [Path(sys.executable).with_name("ncsim"), "view", "--serve", "served", "--no-browser"]
    environment = os.environ | {"PYTHONPATH": str(site), "PYTHONUNBUFFERED": "1"}
    with subprocess.Popen(
        command, cwd=tmp_path, stdout=subprocess.PIPE, text=True, env=environment
    ) as process:
        try:
            assert process.stdout is not None
            page = open_page(process.stdout.readline().strip() + "#v=configure")
            page.get_by_label("scheduler", exact=True).select_option("lookahead", timeout=20_000)
            page.get_by_label("hop weight").fill("2.5")
            page.get_by_label("hop weight").press("Tab")
            until(page, "document.querySelector('#yaml').value.includes('hop_weight: 2.5')")

            assert "What each hop after the first adds" in page.locator(".options").inner_text()
        finally:
            process.terminate()
