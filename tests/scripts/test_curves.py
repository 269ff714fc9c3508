"""kernels/cohesive/curves, the picture of the traction-separation laws: the curves that it draws enclose the fracture energy."""

import numpy as np
import pictures
import pytest

curves = pictures.script("kernels/cohesive/curves")


@pytest.fixture(scope="module")
def laws():
    return curves.Laws()


def words(laws):
    return [laws.facts(law).word.decode() for law in range(laws.count)]


def test_curves_enclose_the_fracture_energy(laws):
    for law, word in enumerate(words(laws)):
        if word == "free":
            continue
        end = laws.facts(law).separation * laws.opening(law)
        path = np.linspace(0, end, 4001)
        first = 0.0 if laws.facts(law).slope[0] > 0 else curves.STRENGTH
        traction = np.array([first, *laws.traction(law, path[1:], curves.SLOW)])
        work = np.trapz(traction, path)
        assert work == pytest.approx(curves.ENERGY, rel=0.012), word  # 1 % is what exponential laws have left at their end
        assert traction.max() == pytest.approx(curves.STRENGTH, rel=1e-3), word


def test_what_unloads_to_the_origin_is_drawn_so(laws):
    law = words(laws).index("linear")
    opening = laws.opening(law)
    down = laws.traction(law, [0.5 * opening, 0.25 * opening, 0.75 * opening], curves.SLOW)
    assert down == pytest.approx([0.5 * curves.STRENGTH, 0.25 * curves.STRENGTH, 0.25 * curves.STRENGTH], rel=1e-12)


def test_what_c_has_and_the_script_has_not_is_noticed(monkeypatch):
    """A field more, which would be read from beyond the end."""
    monkeypatch.setattr(curves, "TABLE", curves.TABLE.replace("sizeof(rg_law_query)", "sizeof(rg_law_query) + 8"))
    with pytest.raises(SystemExit, match="Query is not what C has"):
        curves.Laws()


def test_picture_is_drawn(tmp_path, monkeypatch, capsys):
    monkeypatch.setattr("sys.argv", ["curves", "--out", str(tmp_path / "curves.png")])
    curves.main()
    figure = curves.plt.gcf()
    shown = [pictures.title(axes) for axes in figure.axes if axes.get_visible()]
    assert shown == [word for word in words(curves.Laws()) if word != "free"]
    pictures.assert_readable(figure)
    assert capsys.readouterr().out.strip() == str(tmp_path / "curves.png") and (tmp_path / "curves.png").exists()
