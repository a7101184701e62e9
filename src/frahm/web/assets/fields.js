// Fields and sliders: they follow each other, and tell the rest of the page when a value has changed.
(function () {
  "use strict";
  const page = (window.frahmPage = window.frahmPage || {});
  const PAUSE = 500; // ms after the last key before what stands in a field is taken
  const fields = new Map(); // by name: what is known about it, its two inputs, and its text as last taken

  const make = (tag, properties, attributes) => {
    const element = Object.assign(document.createElement(tag), properties);
    Object.entries(attributes || {}).forEach(([name, value]) => element.setAttribute(name, value));
    return element;
  };

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

  function slide(field, text) {
    const number = Number(text);
    if (text.trim() !== "" && Number.isFinite(number) && !(field.fact.logarithmic && number <= 0)) {
      field.slider.value = toPosition(field.fact, number);
    }
    field.slider.setAttribute("aria-valuetext", text);
  }

  function take(field) {
    clearTimeout(field.timer);
    const text = field.number.value;
    if (text === field.text) return false;
    field.text = text;
    slide(field, text);
    return true;
  }

  function build(fact) {
    const field = { fact: fact, text: fact.text, timer: null };
    const id = (kind) => kind + "-" + fact.key;
    const described = id("hint") + " " + id("problem");
    const label = make("label", { htmlFor: id("field") });
    label.append(fact.title + " ", make("i", { textContent: fact.symbol }), " [" + fact.unit + "]");
    field.number = make("input", { type: "text", id: id("field"), value: fact.text, maxLength: 60, autocomplete: "off", spellcheck: false },
      { "aria-describedby": described });
    field.slider = make("input", { type: "range", id: id("slider"), min: 0, max: fact.steps, step: 1, className: "slider" });
    field.problem = make("p", { id: id("problem"), className: "problem" }, { role: "alert" });
    slide(field, fact.text);
    field.slider.addEventListener("input", () => {
      field.text = field.number.value = fromPosition(fact, Number(field.slider.value));
      clearTimeout(field.timer);
      field.slider.setAttribute("aria-valuetext", field.text);
      page.changed();
    });
    const taken = () => { if (take(field)) page.changed(); };
    field.number.addEventListener("input", () => { clearTimeout(field.timer); field.timer = setTimeout(taken, PAUSE); });
    field.number.addEventListener("change", taken); // left, or Enter: no need to wait
    const row = make("div", { className: "field" });
    row.append(label, field.number, make("label", { htmlFor: id("slider"), textContent: fact.title + ", slider", className: "unseen" }),
      field.slider, make("p", { id: id("hint"), textContent: fact.hint, className: "hint" }), field.problem);
    fields.set(fact.name, field);
    return row;
  }

  page.buildFields = function (facts) {
    const focused = document.activeElement && document.activeElement.id;
    fields.forEach((field) => clearTimeout(field.timer));
    fields.clear();
    document.getElementById("parameters").replaceChildren(...facts.map(build));
    const again = focused && document.getElementById(focused);
    if (again && again !== document.activeElement) again.focus();
  };

  page.values = () => {
    const texts = {};
    fields.forEach((field, name) => { texts[name] = field.text; });
    return texts;
  };

  // Whether a field held something that was not taken yet.
  page.takeAll = () => Array.from(fields.values()).map(take).some(Boolean);

  page.place = function (name, text) {
    const field = fields.get(name);
    if (!field) return;
    field.number.value = text;
    take(field);
  };

  page.explain = function (problems) {
    fields.forEach((field, name) => {
      const text = problems[name] || "";
      if (field.problem.textContent !== text) field.problem.textContent = text;
      if (text) field.number.setAttribute("aria-invalid", "true"); else field.number.removeAttribute("aria-invalid");
    });
  };
})();
