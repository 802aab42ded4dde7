"""The report's interactive plots, as self-contained pieces of HTML."""

from __future__ import annotations

import plotly.graph_objects as go
from plotly.offline import get_plotlyjs

from spavision.tip_path import TipPath

from .discrepancy import Discrepancy
from .figures import COVERAGE, MEASURED_COLOUR, MODELLED_COLOUR


def plotly_script() -> str:
    """Return plotly's JavaScript, to be written into the page once so that it opens offline."""
    script: str = get_plotlyjs()
    return script


def path_plot(discrepancy: Discrepancy) -> str:
    """Return the x-y plot of both tip paths as HTML; the y axis points down, as in the photographs."""
    figure = go.Figure(
        [
            _path_trace("measured", discrepancy.measured, MEASURED_COLOUR, "circle"),
            _path_trace("modelled", discrepancy.modelled, MODELLED_COLOUR, "square"),
        ]
    )
    figure.update_xaxes(title="x displacement, mm")
    figure.update_yaxes(title="y displacement, mm (down)", autorange="reversed", scaleanchor="x")
    return _as_html(figure, "path-plot")


def pressure_plot(discrepancy: Discrepancy) -> str:
    """Return displacement against pressure as HTML, measured readings with their 95 % interval."""
    traces = []
    for component, column, sigma, dash in (
        ("x", "ux_mm", "sigma_ux_mm", "solid"),
        ("y", "uy_mm", "sigma_uy_mm", "dot"),
    ):
        measured, modelled = discrepancy.measured.readings(), discrepancy.modelled.readings()
        traces.append(
            go.Scatter(
                x=measured.pressure_kPa.tolist(),
                y=getattr(measured, column).tolist(),
                error_y={"array": (COVERAGE * getattr(measured, sigma)).tolist()},
                name=f"{component} measured",
                line={"color": MEASURED_COLOUR, "dash": dash},
                marker={"symbol": "circle"},
            )
        )
        traces.append(
            go.Scatter(
                x=modelled.pressure_kPa.tolist(),
                y=getattr(modelled, column).tolist(),
                name=f"{component} modelled",
                line={"color": MODELLED_COLOUR, "dash": dash},
                marker={"symbol": "square"},
            )
        )
    figure = go.Figure(traces)
    figure.update_xaxes(title="pressure, kPa")
    figure.update_yaxes(title="displacement of the tip, mm")
    return _as_html(figure, "pressure-plot")


def _path_trace(name: str, path: TipPath, colour: str, symbol: str) -> go.Scatter:
    readings = path.readings()
    return go.Scatter(
        x=readings.ux_mm.tolist(),
        y=readings.uy_mm.tolist(),
        mode="lines+markers+text",
        text=[f"{pressure:g}" for pressure in readings.pressure_kPa],
        textposition="top right",
        textfont={"size": 10, "color": colour},
        hovertemplate="%{text} kPa: x %{x:.2f} mm, y %{y:.2f} mm",
        name=name,
        line={"color": colour},
        marker={"symbol": symbol, "size": 8},
    )


def _as_html(figure: go.Figure, identifier: str) -> str:
    figure.update_layout(
        template="plotly_white",
        margin={"l": 60, "r": 20, "t": 20, "b": 50},
        legend={"orientation": "h", "yanchor": "bottom", "y": 1.0},
        height=480,
    )
    html: str = figure.to_html(
        full_html=False,
        include_plotlyjs=False,
        div_id=identifier,
        config={"responsive": True, "displaylogo": False},
    )
    return html
