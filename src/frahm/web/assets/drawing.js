// Draws the figures: what stands still came with the page (window.frahmFigures), what moves comes as lines of numbers.
// One figure is drawn in a frame of the browser, so that every drawing is seen.
(function () {
  "use strict";
  const page = (window.frahmPage = window.frahmPage || {});
  const still = JSON.parse(document.getElementById("figures-at-rest").textContent);
  const rank = {};
  Object.keys(still.looks.response).forEach((look, i) => { rank[look] = i; });
  const parts = { live: null, exact: null, stale: false, marks: [], manifold: null, motion: null, now: null, map: null };

  const library = new Promise((resolve) => {
    if (window.Plotly) { resolve(); return; }
    document.getElementById("drawing-library").addEventListener("load", resolve);
  });

  const figure = (name) => document.getElementById(name + "-figure");
  const react = (name, data, layout) => window.Plotly.react(figure(name), data, layout, still.config);

  // ---- one figure a frame, the newest of each; the response first
  const waiting = new Map();
  let free = false; // whether the last drawing has been seen

  function soon(name, draw) {
    waiting.delete(name);
    waiting.set(name, draw);
    if (free) next();
  }

  function next() {
    free = waiting.size === 0;
    if (free) return;
    const name = waiting.has("response") ? "response" : waiting.keys().next().value;
    const draw = waiting.get(name);
    waiting.delete(name);
    const began = performance.now();
    try {
      draw();
    } finally {
      if (name !== "response") page.spent(performance.now() - began);
      seen(next);
    }
  }

  const painted = new MessageChannel();
  let after = null;
  painted.port1.onmessage = () => { const then = after; after = null; then(); };

  function seen(then) {
    after = then;
    const post = () => painted.port2.postMessage(0);
    if (document.hidden) post(); else requestAnimationFrame(post);
  }

  library.then(next);

  // ---- response
  function trace(line) {
    const axes = line.row ? { xaxis: "x2", yaxis: "y2" } : { xaxis: "x", yaxis: "y" };
    const look = still.looks.response[line.look];
    const over = line.hz && line.hz.length // what is said of a point of the wind
      ? { customdata: line.hz, hovertemplate: look.hovertemplate.replace(still.axes.detuning[1], still.axes.place[1]) } : {};
    return Object.assign({}, look, axes, over, line.more, { x: line.x, y: line.y });
  }

  const upright = (x, line) => ({ type: "line", xref: "x", yref: "paper", x0: x, x1: x, y0: 0, y1: 1, layer: "below", line: line });

  function drawResponse() {
    const live = parts.live;
    const exact = parts.exact;
    const valid = exact && !parts.stale;
    const older = (line) => Object.assign({}, line, { more: Object.assign({}, line.more, { opacity: 0.35 }) });
    let lines = live.part.lines.concat(parts.marks);
    if (exact) lines = lines.concat(valid ? exact.lines : exact.lines.map(older));
    lines = lines.concat(valid ? exact.points : live.part.points);
    lines.sort((a, b) => a.row - b.row || rank[a.look] - rank[b.look]);
    const tops = (valid && exact.tops) || live.part.tops || (exact && exact.tops) || [null, null];
    const base = still.layouts.response;
    const axis = (own, range) => Object.assign({}, own, range ? { range: range } : {});
    const shapes = [upright(live.at, { color: still.beside.color, width: 1 })];
    if (live.wind !== null) shapes.push(upright(live.wind, { color: still.beside.wind, width: 1, dash: "dot" }));
    if (live.band) { // behind the lines
      shapes.unshift({ type: "rect", xref: "x", yref: "paper", x0: live.band[0], x1: live.band[1], y0: 0, y1: 1, layer: "below",
        fillcolor: still.beside.band, line: { width: 0 } });
    }
    const title = { title: { text: still.axes[live.axis][0] } };
    if (!live.absorber) lines = lines.filter((line) => !line.row);
    const rows = !live.absorber || lines.some((line) => line.row) ? [] : [{ look: "bare", row: 1, x: [null], y: [null] }]; // keeps its axes
    const axes = live.absorber ? {
      xaxis: axis(base.xaxis, live.window), xaxis2: Object.assign(axis(base.xaxis2, live.window), title),
      yaxis: axis(base.yaxis, tops[0] && [0, tops[0]]), yaxis2: axis(base.yaxis2, tops[1] && [0, tops[1]]),
    } : { // a pipe without absorber has the whole height
      xaxis: Object.assign(axis(base.xaxis2, live.window), title, { anchor: "y" }),
      yaxis: Object.assign(axis(base.yaxis, tops[0] && [0, tops[0]]), { domain: [0, 1] }),
    };
    const { xaxis, xaxis2, yaxis, yaxis2, ...rest } = base;
    react("response", lines.concat(rows).map(trace), Object.assign(rest, axes, {
      shapes: shapes, uirevision: live.axis + live.absorber,
    }));
    listen("response", (point) => page.clicked(point.x, point.y, point.data.yaxis === "y2"));
  }

  function listen(name, heard) {
    const box = figure(name);
    if (box.frahmListens) return;
    box.frahmListens = true;
    box.on("plotly_click", (click) => { if (click && click.points && click.points.length) heard(click.points[0]); });
  }

  // ---- manifold and map
  function drawManifold() {
    const looks = still.looks.manifold;
    const lines = Object.assign({}, parts.manifold.lines, parts.motion ? { motion: parts.motion } : {});
    const data = Object.keys(looks).filter((look) => lines[look] && lines[look].x.length)
      .map((look) => Object.assign({ type: "scatter" }, looks[look], { x: lines[look].x, y: lines[look].y }));
    const base = still.layouts.manifold;
    const yaxis = Object.assign({}, base.yaxis, { range: [0, parts.manifold.top] });
    react("manifold", data, Object.assign({}, base, { yaxis: yaxis }));
  }

  function drawMap() {
    const map = parts.map;
    const looks = still.looks.map;
    const base = still.layouts.map;
    const yaxis = Object.assign({}, base.yaxis, { range: map.range, title: { text: map.title } });
    const xaxis = Object.assign({}, base.xaxis, { range: map.window });
    react("map", [
      Object.assign({}, looks.classes, { x: map.x, y: map.y, z: map.z }),
      Object.assign({}, looks.now, { x: [parts.now[0]], y: [parts.now[1]] }),
    ], Object.assign({}, base, { xaxis: xaxis, yaxis: yaxis }));
    listen("map", (point) => page.mapped(point.x, point.y));
  }

  // ---- what the rest of the script calls
  page.library = library;

  page.showResponse = function (answer, then) {
    const kept = parts.live && parts.live.key === answer.key;
    if (!kept) { // the exact curve of other values: gone, or pale if nothing live takes its place
      if (answer.slow) parts.exact = null; else parts.stale = true;
    }
    if (!kept || parts.live.at !== answer.at) parts.marks = [];
    parts.live = answer;
    soon("response", () => { drawResponse(); then(); });
  };

  page.showExact = function (part) {
    parts.exact = part;
    parts.stale = false;
    soon("response", drawResponse);
  };

  page.hasExact = () => parts.exact !== null && !parts.stale;

  page.showMarks = function (lines) {
    parts.marks = lines;
    soon("response", drawResponse);
  };

  page.showBeside = function (answer) {
    if (answer.map) parts.map = answer.map;
    parts.manifold = answer.manifold;
    const moved = String(parts.now) !== String(answer.now);
    parts.now = answer.now;
    soon("manifold", drawManifold);
    if (answer.map || moved) soon("map", drawMap);
  };

  page.forgetMotion = () => { parts.motion = null; };

  page.showMotion = function (drawn) {
    soon("motion", () => react("motion", drawn.figure.data, drawn.figure.layout));
    if (!drawn.slow) return;
    parts.motion = { x: drawn.slow[0], y: drawn.slow[1] };
    if (parts.manifold) soon("manifold", drawManifold);
  };
})();
