// Charts: what the page's data say, as far as the choices on the page want it, in the colours of the day.
(() => {
  const root = document.documentElement;
  root.classList.add("js");
  const data = JSON.parse(document.getElementById("data").textContent);
  const dark = matchMedia("(prefers-color-scheme: dark)");
  const touch = matchMedia("(hover: none), (pointer: coarse)");
  const narrow = matchMedia("(max-width: 760px)");

  const FONT = "system-ui, sans-serif";

  const decoded = new Map();
  const numbers = (index) => {
    if (!decoded.has(index)) {
      const bytes = Uint8Array.from(atob(data.arrays[index]), (letter) => letter.charCodeAt(0));
      decoded.set(index, new Float32Array(bytes.buffer));
    }
    return decoded.get(index);
  };
  const escaped = (text) => text.replace(/&/g, "&amp;").replace(/</g, "&lt;").replace(/>/g, "&gt;");
  const colour = (name) => getComputedStyle(root).getPropertyValue(`--${name === "soft" ? "truth" : name}`).trim();

  const chosen = (name, value) =>
    [...document.querySelectorAll("input")].some((box) => box.name === name && box.value === value && box.checked);
  const wanted = (part) => Object.entries(part.when).every(([name, value]) => chosen(name, value));

  // What is told at a point: lines of "label value unit", of what there is a value of.
  const lines = (trace, i) =>
    trace.hover.flatMap(({ label, values, digits, unit, plus }) => {
      const value = numbers(values)[i] + (plus === null ? 0 : numbers(plus)[i]);
      return Number.isNaN(value) ? [] : [`${label} ${value.toFixed(digits)}${unit ? ` ${unit}` : ""}`];
    });
  const label = (trace, i) => `<b>${escaped(trace.name)}</b><br>${lines(trace, i).map(escaped).join("<br>")}`;

  const drawn = (trace) => ({
    type: "scatter",
    name: escaped(trace.name),
    x: numbers(trace.x),
    y: numbers(trace.y),
    mode: trace.mode,
    opacity: trace.opacity,
    line: { color: colour(trace.colour), width: trace.width, dash: trace.dash },
    marker: { color: colour(trace.colour), size: trace.size, symbol: trace.symbol, line: { width: trace.symbol.endsWith("-open") ? 2 : 0 } },
    ...(trace.hover.length
      ? { hoverinfo: "text", hovertext: Array.from(numbers(trace.x), (_, i) => label(trace, i)) }
      : { hoverinfo: "skip" }),
  });

  const axis = (told) => ({
    title: { text: escaped(told.title), standoff: 8 },
    type: told.log ? "log" : "linear",
    color: colour("ink"),
    gridcolor: colour("grid"),
    zerolinecolor: colour("line"),
    automargin: true,
    ...(told.ticks.length
      ? { tickvals: told.ticks.map((tick) => tick[0]), ticktext: told.ticks.map((tick) => escaped(tick[1])) }
      : { nticks: narrow.matches ? 5 : 8 }),
    ...(told.bounds ? { range: told.log ? told.bounds.map(Math.log10) : told.bounds } : {}),
  });

  const layout = (chart) => ({
    paper_bgcolor: "rgba(0,0,0,0)",
    plot_bgcolor: "rgba(0,0,0,0)",
    font: { color: colour("ink"), family: FONT, size: 12 },
    margin: { l: 8, r: 12, t: 8, b: 8 },
    showlegend: false,
    hovermode: "closest",
    hoverlabel: { bgcolor: colour("card"), bordercolor: colour("soft"), font: { color: colour("ink"), family: FONT }, align: "left" },
    dragmode: touch.matches ? false : "zoom",
    uirevision: JSON.stringify(chart.when), // what was zoomed stays so while methods come and go
    xaxis: axis(chart.x),
    yaxis: { ...axis(chart.y), ...(chart.equal ? { scaleanchor: "x" } : {}) },
    shapes: chart.marks.map(({ axis, low, high, colour: name, dash }) => {
      const across = axis === "x" ? "y" : "x", line = low === high;
      return {
        type: line ? "line" : "rect", layer: line ? "above" : "below",
        [`${axis}0`]: low, [`${axis}1`]: high,
        [`${across}0`]: 0, [`${across}1`]: 1, [`${across}ref`]: "paper",
        line: { color: colour(name), width: line ? 2 : 0, dash },
        fillcolor: colour(name), opacity: line ? 1 : 0.2,
      };
    }),
  });

  const config = {
    responsive: true,
    displaylogo: false,
    displayModeBar: touch.matches ? false : "hover",
    modeBarButtonsToRemove: ["lasso2d", "select2d", "autoScale2d"],
    showTips: false,
  };

  const shown = new Map(); // place -> the traces that are drawn there

  const draw = (changed) => {
    for (const chart of data.charts) {
      const depends = [chart, ...chart.traces].some((part) => changed in part.when);
      if (!wanted(chart) || (changed && !depends)) continue;
      const place = document.getElementById(chart.place);
      const traces = chart.traces.filter(wanted);
      const first = !shown.has(chart.place);
      shown.set(chart.place, traces);
      document.getElementById(`${chart.place}-readout`).textContent = "";
      Plotly.react(place, traces.map(drawn), layout(chart), config);
      if (first) listen(place);
    }
  };

  const listen = (place) => {
    const readout = document.getElementById(`${place.id}-readout`);
    const say = (curve, point) => {
      const trace = shown.get(place.id)[curve];
      readout.textContent = `${trace.name}: ${lines(trace, point).join(", ")}`;
    };
    let here = null;
    for (const event of ["plotly_hover", "plotly_click"]) { // a tap is told as a click alone
      place.on(event, ({ points: [at] }) => {
        here = { curve: at.curveNumber, point: at.pointNumber };
        say(here.curve, here.point);
      });
    }
    // By keys: left and right along a line, up and down to another.
    place.addEventListener("keydown", (event) => {
      const step = { ArrowLeft: -1, ArrowRight: 1, PageUp: -20, PageDown: 20, Home: -Infinity, End: Infinity }[event.key];
      const other = { ArrowUp: -1, ArrowDown: 1 }[event.key];
      const told = shown.get(place.id);
      const curves = told.map((trace, i) => i).filter((i) => told[i].hover.length);
      if (!curves.length || (step === undefined && other === undefined)) return;
      event.preventDefault();
      const at = curves.indexOf(here?.curve);
      const curve = at < 0 ? curves[0] : curves[(at + (other || 0) + curves.length) % curves.length];
      const last = numbers(told[curve].x).length - 1;
      const point = Math.min(Math.max((at < 0 ? 0 : here.point) + (at < 0 ? 0 : step || 0), 0), last);
      here = { curve, point };
      Plotly.Fx.hover(place, [{ curveNumber: curve, pointNumber: point }]);
      say(curve, point);
    });
  };

  document.addEventListener("change", (event) => draw(event.target.name));
  for (const query of [dark, touch, narrow]) query.addEventListener("change", () => draw());
  const printing = (on) => { root.classList.toggle("print", on); if (dark.matches) draw(); };
  addEventListener("beforeprint", () => printing(true));
  addEventListener("afterprint", () => printing(false));
  draw();
})();
