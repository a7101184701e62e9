// The course of things: a change is asked about at once, with one question under way at a time (the newest values
// follow), manifold and map when there is time, the exact response when the sliders rest; and a server that has ended
// is noticed.
(function () {
  "use strict";
  const page = (window.frahmPage = window.frahmPage || {});
  const REST = 250; // ms without a change after which the sliders count as released
  const GIVE_UP = 15000; // ms after which a question without an answer no longer holds up the next
  const PAUSE = 150; // ms from one answer about manifold and map to the next question about them, at least
  const SHARE = 6; // times as long as they took to draw is left to the response
  const LATE = 500; // ms without an answer after which what is drawn is marked as of older values
  const BEAT = 2000; // ms between signs of life
  const state = { case: null, session: null, plane: "kappa", tuned: false, number: 0, key: null, at: null, axis: null, absorber: true, slow: true };
  const set = (id, props) => window.dash_clientside.set_props(id, props);
  const say = (id, text) => { const place = document.getElementById(id); if (place.textContent !== text) place.textContent = text; };
  const fade = (id, look) => { const place = document.getElementById(id); if (place && place.className !== look) set(id, { className: look }); };

  // One kind of question to the server: one under way at a time, and only the newest waits.
  // `late` is told true when an answer is overdue, and false when the newest one, or one in time, has come.
  function asker(path, wanted, heard, late) {
    const own = { sent: -1, turn: 0, since: 0, busy: false, overdue: null };
    own.ask = async function () {
      if (own.busy && Date.now() - own.since < GIVE_UP) return;
      const number = state.number;
      const mine = (own.turn += 1);
      const since = Date.now();
      Object.assign(own, { busy: true, sent: number, since: since });
      clearTimeout(own.overdue);
      if (late) own.overdue = setTimeout(() => late(true), LATE);
      let answer = null;
      try {
        const response = await fetch(path, { method: "POST", headers: { "Content-Type": "application/json" }, body: JSON.stringify(wanted()) });
        answer = response.ok ? await response.json() : null;
        if (!response.ok) say("slow-status", "This could not be computed: the terminal that runs the page says why.");
      } catch (error) { // it has ended: the beat says so
        if (late) say("slow-status", "No answer came: what is drawn is of the last values.");
      }
      if (own.turn !== mine) return; // given up meanwhile
      own.busy = false;
      if (own.sent !== state.number && answer !== null) own.again();
      if (late && !own.busy) clearTimeout(own.overdue);
      if (late && (!own.busy || Date.now() - since < LATE)) late(false);
      if (answer !== null) heard(answer, number);
    };
    own.again = own.ask;
    return own;
  }

  const values = () => ({ case: state.case, session: state.session, values: page.values() });
  const drawn = asker("drawn/response", () => Object.assign(values(), { tuned: state.tuned }), answered, waiting);
  const beside = asker("drawn/beside", () => Object.assign(values(), { plane: state.plane, drawn: beside.key || "" }), answeredBeside);
  beside.again = () => besides();
  const exact = asker("drawn/exact", values, answeredExact);
  exact.again = () => {};
  let rest = null;
  let pause = null;

  function want() {
    state.number += 1;
    clearTimeout(rest);
    drawn.ask();
  }
  page.changed = want;

  function answered(answer, number) {
    page.explain(answer.problems);
    say("slow-status", answer.status);
    if (Object.keys(answer.problems).length) {
      window.frahmDrawn = number;
      return;
    }
    const other = answer.key !== state.key;
    const elsewhere = other || answer.at !== state.at;
    const first = state.key === null;
    Object.assign(state, { key: answer.key, at: answer.at, axis: answer.axis, window: answer.window });
    entitle(answer.heading);
    if (state.slow !== answer.slow) arrange(answer.slow);
    document.body.classList.toggle("no-absorber", !answer.absorber);
    state.absorber = answer.absorber;
    if (elsewhere) page.forgetMotion();
    page.showResponse(answer, () => { window.frahmDrawn = number; });
    if (other) {
      say("exact-status", "The exact response follows when the sliders rest.");
      undecide();
    }
    if (elsewhere && !first) { // what was computed on demand belongs to other values
      fade("motion-holder", "stale");
      fade("attractors", "stale");
    }
    besides();
    clearTimeout(rest);
    if (number === state.number && !page.hasExact()) rest = setTimeout(settle, REST);
  }

  function waiting(on) {
    ["response", "map", "manifold"].forEach((id) => document.getElementById(id).classList.toggle("stale", on));
    if (on) say("slow-status", "Computing …" + (state.key === null ? "" : " What is drawn, in a paler tint, is of the last values."));
  }

  function entitle(heading) { // a changed value is not what the title was given for
    const place = document.getElementById("case-name");
    if (place.textContent !== heading) set("case-name", { children: heading });
  }

  function arrange(slow) {
    state.slow = slow;
    document.getElementById("beside").hidden = !slow;
    document.body.classList.toggle("no-slow", !slow);
  }

  function besides() {
    clearTimeout(pause);
    if (!state.slow || beside.busy || beside.sent === state.number) return;
    const early = (beside.until || 0) - Date.now();
    if (early > 0) { pause = setTimeout(besides, early); return; }
    beside.ask();
  }

  page.spent = (time) => { beside.until = Math.max(beside.until || 0, Date.now()) + SHARE * time; };

  function answeredBeside(answer) {
    beside.until = Date.now() + PAUSE;
    if (!answer.manifold) return;
    if (answer.map) beside.key = answer.key;
    page.showBeside(answer);
    say("manifold-status", answer.status);
  }

  function settle() {
    say("exact-status", "Computing the exact response … (the first time ever, its code is compiled, which takes about a minute)");
    exact.busy = false; // the newest question ends an older one
    exact.ask();
  }

  function answeredExact(answer, number) {
    if (!answer.key || drawn.busy || answer.key !== state.key) return; // newer values come: they ask again
    if (answer.part) page.showExact(answer.part);
    say("exact-status", answer.status);
    decide(answer.key);
  }

  // ---- the decision: one device after the other, those in closed form first
  const cells = ["peak", "ratio", "place", "used", "verdict"];
  const rowOf = (device) => document.getElementById("decision-" + device);

  function undecide() {
    ["bare", "this", "tuned"].forEach((device) => rowOf(device).classList.add("stale"));
    say("decision-status", "Computed when the sliders rest; what is shown in a paler tint is of other values.");
  }

  async function decide(key) {
    let sentence = "";
    for (const device of state.absorber ? ["bare", "tuned", "this"] : ["bare", "tuned"]) {
      say("decision-status", sentence + "Searching the worst lasting motion over the range …");
      let answer = {};
      try {
        const response = await fetch("drawn/decision", { method: "POST", headers: { "Content-Type": "application/json" },
          body: JSON.stringify(Object.assign(values(), { device: device })) });
        answer = response.ok ? await response.json() : {};
      } catch (error) { // it has ended: the beat says so
      }
      if (state.key !== key) return; // newer values come: they ask again
      if (answer.key !== key) {
        say("decision-status", sentence + "Not finished: what was asked for went before. A changed value starts it again.");
        return;
      }
      cells.forEach((name) => say("decision-" + device + "-" + name, answer.row[name]));
      rowOf(device).classList.remove("stale");
      rowOf(device).dataset.verdict = answer.row.verdict;
      if (answer.row.sentence) sentence = answer.row.sentence + " ";
    }
    say("decision-status", sentence);
  }

  // ---- what the buttons lead to
  const opened = function (facts, kase, session) {
    // The page itself, another case, or a preset: all fields anew.
    const first = state.session === null;
    state.case = JSON.stringify(kase);
    state.session = session;
    page.buildFields(facts);
    hand();
    page.forgetMotion();
    want();
    if (!first) return;
    beat();
    new MutationObserver(nameFile).observe(document.querySelector("header"), { childList: true, subtree: true });
    nameFile();
    window.frahmReady = true;
  };

  function nameFile() {
    const file = document.querySelector("#load input[type=file]"); // it comes when its code has been loaded
    if (file) { file.setAttribute("aria-label", "Case file to load"); file.tabIndex = -1; } // the button opens it
  }

  const placed = function (texts) {
    if (!texts) return;
    Object.entries(texts).forEach(([name, text]) => page.place(name, text));
    hand();
    want();
  };

  const press = (id, pressed) => {
    const button = document.getElementById(id);
    if (button) button.setAttribute("aria-pressed", String(pressed));
  };

  const chosen = () => window.dash_clientside.callback_context.triggered[0].prop_id.split(".")[0].slice("plane-".length);

  const again = function (plane, tuned) {
    ["kappa", "xi2"].forEach((name) => press("plane-" + name, name === plane));
    state.plane = plane;
    state.tuned = (tuned || 0) % 2 === 1;
    press("tuned", state.tuned);
    if (state.session !== null) want();
  };

  const marked = (lines) => { if (lines) page.showMarks(lines); };
  const moved = (drawing) => { if (drawing) page.showMotion(drawing); };

  // A detuning as a field shows it: without the rounding of the curve, unless that takes it out of the window.
  function rounded(x) {
    const short = Number(Number(x.toFixed(9)).toPrecision(6));
    return short >= state.window[0] && short <= state.window[1] ? short : x;
  }

  page.clicked = function (x, y, second) {
    const at = rounded(x);
    page.place(state.axis, String(at));
    hand();
    want();
    set("clicked", { data: { place: at, near: second ? [null, y] : [y, null], at: Date.now() } });
  };

  page.mapped = function (x, y) {
    page.place("detuning", String(Number(x.toPrecision(4))));
    page.place(state.plane, String(Number(y.toPrecision(4))));
    want();
  };

  // An action takes the values as the fields show them: they are handed over before it is heard of.
  function hand() {
    if (page.takeAll()) want();
    set("values", { data: page.values() });
  }
  const acts = (event) => event.target.closest && event.target.closest("button");
  window.addEventListener("click", (event) => { if (acts(event)) hand(); }, true);

  // ---- signs of life
  let timer = null;
  async function beat() {
    clearTimeout(timer);
    const lost = document.getElementById("lost");
    try {
      const answer = await fetch("alive/" + state.session, { method: "POST", signal: AbortSignal.timeout(10000) });
      if (!answer.ok) throw new Error(answer.status);
      if (lost && !lost.hidden) lost.hidden = true;
    } catch (error) {
      if (lost) {
        lost.hidden = false;
        lost.textContent = "The program behind this page has ended or does not answer: nothing here is computed any more. " +
          "Start it again with “frahm app”; what is shown stays until this page is reloaded.";
      }
    }
    timer = setTimeout(beat, BEAT);
  }

  window.addEventListener("pagehide", () => {
    if (state.session) navigator.sendBeacon("closed/" + state.session);
  });

  window.dash_clientside = Object.assign({}, window.dash_clientside, { frahm: { opened, placed, chosen, again, marked, moved } });
})();
