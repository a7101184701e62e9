// What must happen in the browser: sliders and fields follow each other, one request is under way at a time while a
// slider is dragged (the newest values follow when the last are drawn), and a server that has ended is noticed.
(function () {
  "use strict";
  const REST = 250; // ms without a change after which a slider counts as released
  const GIVE_UP = 15000; // ms after which a request without an answer no longer holds up the next
  const PAUSE = 120; // ms between two drawings of manifold and map
  const BEAT = 2000; // ms between signs of life
  const state = { values: null, facts: {}, set: {}, number: 0, sent: 0, waiting: false, held: 0, timer: null, session: null,
    besideSent: 0, besideHeld: 0, besideWaiting: false, besideTimer: null };
  const set = (id, props) => window.dash_clientside.set_props(id, props);
  const skip = () => window.dash_clientside.no_update;

  function learn(facts, texts) {
    state.facts = {};
    facts.forEach((fact) => { state.facts[fact.key] = fact; });
    state.values = {};
    facts.forEach((fact, i) => { state.values[fact.name] = texts[i]; });
  }

  function fromPosition(fact, position) {
    const share = position / fact.steps;
    const value = fact.logarithmic ? fact.low * Math.pow(fact.high / fact.low, share) : fact.low + share * (fact.high - fact.low);
    return String(Number(value.toPrecision(4)));
  }

  function toPosition(fact, value) {
    const ratio = fact.logarithmic
      ? Math.log(value / fact.low) / Math.log(fact.high / fact.low)
      : (value - fact.low) / (fact.high - fact.low);
    return Math.round(fact.steps * Math.min(1, Math.max(0, ratio)));
  }

  function describe(fact, text) {
    const slider = document.getElementById("slider-" + fact.key);
    if (slider) slider.setAttribute("aria-valuetext", text);
  }

  function want() {
    state.number += 1;
    clearTimeout(state.timer);
    if (state.waiting && Date.now() - state.held < GIVE_UP) return;
    send();
  }

  function send() {
    state.waiting = true;
    state.held = Date.now();
    state.sent = state.number;
    set("wanted", { data: { number: state.sent, values: Object.assign({}, state.values) } });
  }

  function place(fact, text) {
    // Set field and slider of one parameter without taking that for a change made by the visitor.
    state.values[fact.name] = text;
    state.set["field-" + fact.key] = text;
    set("field-" + fact.key, { value: text });
    const number = Number(text);
    if (text.trim() !== "" && Number.isFinite(number)) {
      const position = toPosition(fact, number);
      state.set["slider-" + fact.key] = position;
      set("slider-" + fact.key, { value: position });
    }
    describe(fact, text);
  }

  const moved = function (...all) {
    const facts = all.pop();
    const count = facts.length;
    if (state.values === null) learn(facts, all.slice(count));
    let changed = false;
    window.dash_clientside.callback_context.triggered.forEach((trigger) => {
      const id = trigger.prop_id.split(".")[0];
      const [kind, key] = [id.slice(0, id.indexOf("-")), id.slice(id.indexOf("-") + 1)];
      const fact = state.facts[key];
      if (!fact || state.set[id] === trigger.value || (kind === "slider" && String(state.set[id]) === String(trigger.value))) return;
      delete state.set[id];
      const text = kind === "slider" ? fromPosition(fact, Number(trigger.value)) : String(trigger.value === null ? "" : trigger.value);
      if (text === state.values[fact.name]) return;
      state.values[fact.name] = text;
      if (kind === "slider") {
        state.set["field-" + key] = text;
        set("field-" + key, { value: text });
      } else if (text.trim() !== "" && Number.isFinite(Number(text)) && !(fact.logarithmic && Number(text) <= 0)) {
        const position = toPosition(fact, Number(text));
        state.set["slider-" + key] = position;
        set("slider-" + key, { value: position });
      }
      describe(fact, text);
      changed = true;
    });
    if (changed) want();
  };

  const loaded = function (facts, texts) {
    // Another case, or another set of values: everything is placed anew.
    if (!texts) return;
    learn(facts, facts.map((fact) => texts[fact.name]));
    facts.forEach((fact) => place(fact, texts[fact.name]));
    want();
  };

  const press = (id, pressed) => {
    const button = document.getElementById(id);
    if (button) button.setAttribute("aria-pressed", String(pressed));
  };

  const chosen = function () {
    return window.dash_clientside.callback_context.triggered[0].prop_id.split(".")[0].slice("plane-".length);
  };

  const again = function (plane, tuned) {
    ["kappa", "xi2"].forEach((name) => press("plane-" + name, name === plane));
    press("tuned", (tuned || 0) % 2 === 1);
    if (state.values !== null) want();
  };

  const drawn = function (answer) {
    if (!answer) return;
    const problems = answer.problems || {};
    Object.values(state.facts).forEach((fact) => {
      const field = document.getElementById("field-" + fact.key);
      if (!field) return;
      field.setAttribute("aria-describedby", "hint-" + fact.key + " problem-" + fact.key);
      if (problems[fact.name]) field.setAttribute("aria-invalid", "true"); else field.removeAttribute("aria-invalid");
    });
    state.waiting = false;
    window.frahmDrawn = answer.number;
    const file = document.querySelector("#load input[type=file]");
    if (file) { file.setAttribute("aria-label", "Case file to load"); file.tabIndex = -1; } // the button opens it
    besides();
    if (state.number !== state.sent) { send(); return; }
    clearTimeout(state.timer);
    if (Object.keys(problems).length === 0 && answer.exact) {
      state.timer = setTimeout(() => set("settled", { data: { number: answer.number, values: answer.values } }), REST);
    }
  };

  function besides() {
    // Manifold and map: one request at a time too, and none so soon that the response would have to wait for it.
    const now = Date.now();
    clearTimeout(state.besideTimer);
    if (state.besideSent === state.number) return;
    if (state.besideWaiting && now - state.besideHeld < GIVE_UP) return;
    const soon = state.besideHeld + PAUSE - now;
    if (soon > 0 && !state.besideWaiting) { state.besideTimer = setTimeout(besides, soon); return; }
    state.besideWaiting = true;
    state.besideHeld = now;
    state.besideSent = state.number;
    set("beside", { data: { number: state.number, values: Object.assign({}, state.values) } });
  }

  const drawnBeside = function (answer) {
    if (!answer) return;
    state.besideWaiting = false;
    state.besideHeld = Date.now();
    besides();
  };

  const started = function (session) {
    state.session = session;
    beat();
    want(); // the values as they stand: from here on the server answers
    window.frahmReady = true;
  };

  const toValue = (name, value) => {
    const fact = Object.values(state.facts).find((one) => one.name === name);
    if (fact) { place(fact, String(value)); }
  };

  const clicked = function (click) {
    if (!click || !click.points || !click.points.length) return skip();
    const point = click.points[0];
    const rows = point.curveNumber >= window.frahmTraces ? [null, point.y] : [point.y, null];
    toValue("detuning", Number(point.x));
    want();
    return { detuning: Number(point.x), near: rows, at: Date.now() };
  };

  const mapped = function (click, plane) {
    if (!click || !click.points || !click.points.length) return;
    toValue("detuning", Number(Number(click.points[0].x).toPrecision(4)));
    toValue(plane, Number(Number(click.points[0].y).toPrecision(4)));
    want();
  };

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
  const commit = (field) => {
    // A field that is left, or Enter in it, is a change at once, not after the pause that typing needs.
    if (field.id && field.id.startsWith("field-")) set(field.id, { value: field.value });
  };
  window.addEventListener("focusout", (event) => commit(event.target));
  window.addEventListener("keydown", (event) => { if (event.key === "Enter") commit(event.target); });

  window.dash_clientside = Object.assign({}, window.dash_clientside, { frahm: { moved, loaded, chosen, again, drawn, drawnBeside, started, clicked, mapped } });
})();
