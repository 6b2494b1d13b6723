"use strict";
// Moves the robots of a plan on their stage. Everything it shows comes from the JSON block; texts are
// only ever set as text.
(() => {
  const plan = JSON.parse(document.getElementById("plan").textContent);
  const { robots, bases } = plan;
  const last = plan.length;
  const first = plan.loop_start;
  const round = last - first + 1;
  if (robots.length === 0 || robots.some((r) => r.points.length <= last)) return;

  const SVG = "http://www.w3.org/2000/svg";
  const byId = (id) => document.getElementById(id);
  const set = (element, attributes) => {
    for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
    return element;
  };
  const svg = (name, attributes = {}) => set(document.createElementNS(SVG, name), attributes);
  const html = (name, className = "", text = "") => {
    const element = document.createElement(name);
    if (className) element.className = className;
    if (text) element.textContent = text;
    return element;
  };
  const still = window.matchMedia("(prefers-reduced-motion: reduce)");

  // What is shown: the time in steps, which grows for ever; who is chosen, who is pointed at.
  let now = 0;
  let playing = false;
  let picked = null;
  let pointed = null;
  let shownStep = -1;
  let shownFocus = null;
  let before = null;

  // The position in the lasso of a step that may lie rounds later.
  const fold = (step) => (step <= last ? step : first + ((step - first) % round));
  const between = (a, b, share) => [a[0] + (b[0] - a[0]) * share, a[1] + (b[1] - a[1]) * share];
  const along = (points, time) => {
    const step = Math.floor(time);
    return between(points[fold(step)], points[fold(step + 1)], time - step);
  };
  const move = ([x, y]) => `translate(${x.toFixed(2)} ${y.toFixed(2)})`;
  const line = (points) => "M" + points.map(([x, y]) => `${x.toFixed(2)} ${y.toFixed(2)}`).join("L");
  // The texts of one signal's values at all steps, with as many decimals as its largest one needs.
  const texts = (values) => {
    const sizes = values.map((value) => Math.abs(value));
    const largest = Math.max(1e-3, ...sizes.filter((size) => Number.isFinite(size)));
    const decimals = Math.max(0, 3 - Math.floor(Math.log10(largest)));
    const text = (value) => {
      if (typeof value !== "number") return "?";
      const fixed = largest < 1e7 ? value.toFixed(decimals) : value.toExponential(3);
      return (Number(fixed) === 0 ? fixed.replace("-", "") : fixed).replace(/-/g, "\u2212");
    };
    return values.map(text);
  };
  const raised = { 1: "\u00b9", 2: "\u00b2", 3: "\u00b3", 4: "\u2074", 5: "\u2075" };
  const unitOf = (unit) => (unit === "1" ? "" : unit.replace(/\^([1-5])(?![0-9])/g, (_, digit) => raised[digit]));
  const seconds = (step) => `${Number((step * plan.step_s).toFixed(3))} s`;
  const counted = (count, one, more) => `${count} ${count === 1 ? one : more}`;
  const nameOf = (node) => (node < robots.length ? robots[node] : bases[node - robots.length]).name;
  const placeOf = (node) => (node < robots.length ? along(robots[node].points, now) : bases[node - robots.length].at);

  // The links from a robot to its base at a step: pairs of nodes.
  const route = (robot, step) => {
    const pairs = [];
    let node = robot;
    while (node !== null && node < robots.length && pairs.length <= robots.length) {
      const hop = plan.hops[step][node];
      if (!hop) break;
      pairs.push([node, hop[0]]);
      node = hop[0];
    }
    return pairs;
  };
  const focus = () => (pointed !== null ? pointed : picked);

  // --- The stage ---
  const stage = document.importNode(byId("stage").content, true).querySelector("svg.stage");
  const layer = {};
  for (const element of stage.querySelectorAll("[data-layer]")) layer[element.dataset.layer] = element;

  const actors = robots.map((robot, index) => {
    const tube = svg("g", { stroke: robot.color, fill: robot.color });
    tube.append(svg("path", { d: robot.tube }));
    const trail = svg("path", { stroke: robot.color, d: "" });
    const body = svg("g", { tabindex: "0", role: "button", "aria-pressed": "false", fill: robot.color });
    body.setAttribute("aria-label", `robot ${robot.name}`);
    body.append(
      svg("circle", { class: "p-halo", r: "15" }),
      svg("path", { class: "p-body", d: robot.mark }),
    );
    const halo = svg("text", { class: `halo name mid ${robot.ink}` });
    const name = svg("text", { class: `name mid ${robot.ink}` });
    const short = robot.name.length > 24 ? robot.name.slice(0, 23) + "\u2026" : robot.name;
    halo.textContent = short;
    name.textContent = short;
    const shadow = robot.feet.length > 0 ? svg("path", { stroke: robot.color }) : null;
    layer.tubes.append(tube);
    layer.trails.append(trail);
    layer.robots.append(body);
    layer.names.append(halo, name);
    if (shadow) layer.shadows.append(shadow);
    const dots = robot.runs.map(() => svg("circle", { r: "2.2", fill: robot.color }));
    layer.dots.append(...dots);
    body.addEventListener("click", () => pick(index));
    body.addEventListener("keydown", (event) => {
      if (event.key === "Enter" || event.key === " ") {
        pick(index);
        event.preventDefault();
        event.stopPropagation();
      }
    });
    body.addEventListener("pointerenter", () => point(index));
    body.addEventListener("pointerleave", () => point(null));
    body.addEventListener("focus", () => point(index));
    body.addEventListener("blur", () => point(null));
    return { robot, tube, trail, body, halo, name, shadow, dots };
  });

  // The way so far: long ones are cut, at their beginning.
  const LONGEST_TRAIL = 400;
  const trailOf = (robot) => {
    const step = Math.floor(now);
    const begin = Math.max(0, step - Math.min(last + 1, LONGEST_TRAIL));
    const points = [];
    for (let s = begin; s <= step; s += 1) points.push(robot.points[fold(s)]);
    points.push(along(robot.points, now));
    return points;
  };
  // A simulated run that is over goes on with its last round.
  const dotOf = (run) => {
    if (run.length < 2) return run[0] || [0, 0];
    let time = now;
    if (time > run.length - 1) {
      const from = run.length - 1 >= round ? run.length - 1 - round : 0;
      time = from + ((time - from) % (run.length - 1 - from || 1));
    }
    const step = Math.min(Math.floor(time), run.length - 2);
    return between(run[step], run[step + 1], time - step);
  };

  let lines = [];
  const showLinks = () => {
    const step = fold(Math.floor(now));
    const hot = new Set();
    const onWay = new Set();
    if (focus() !== null) {
      for (const [from, to] of route(focus(), step)) {
        hot.add(`${from} ${to}`).add(`${to} ${from}`);
        onWay.add(from).add(to);
      }
    }
    lines = plan.links[step].map((link) => {
      const isHot = hot.has(link.ends.join(" "));
      return { link, path: svg("path", isHot ? { class: "p-hot" } : {}), isHot };
    });
    layer.links.replaceChildren(...[...lines].sort((a, b) => a.isHot - b.isHot).map((l) => l.path));
    layer.beams.replaceChildren(...plan.links[step].map((link) => svg("path", { d: link.beam })));
    actors.forEach(({ body }, index) => {
      body.classList.toggle("p-hot", onWay.has(index));
      body.classList.toggle("p-picked", picked === index);
      body.setAttribute("aria-pressed", String(picked === index));
    });
  };
  // A name stands above its robot, or below it where another one's name is in the way.
  const nameRow = ([x, y], text, taken) => {
    const half = 4.6 * text.length;
    const free = (row) => taken.every((t) => Math.abs(t.x - x) > t.half + half || Math.abs(t.row - row) > 16);
    const row = free(y - 14) || !free(y + 25) ? y - 14 : y + 25;
    taken.push({ x, row, half });
    return row;
  };
  const place = () => {
    const share = now - Math.floor(now);
    const taken = [];
    for (const { robot, tube, trail, body, halo, name, shadow, dots } of actors) {
      const at = along(robot.points, now);
      tube.setAttribute("transform", move(at));
      body.setAttribute("transform", move(at));
      const spot = { x: at[0].toFixed(2), y: nameRow(at, name.textContent, taken).toFixed(2) };
      for (const text of [halo, name]) set(text, spot);
      trail.setAttribute("d", line(trailOf(robot)));
      if (shadow) shadow.setAttribute("d", line([at, along(robot.feet, now)]));
      dots.forEach((dot, run) => {
        const [x, y] = dotOf(robot.runs[run]);
        set(dot, { cx: x.toFixed(2), cy: y.toFixed(2) });
      });
    }
    // Links are promised at the steps: between them they fade, and where they can be is not shown.
    for (const { link, path } of lines) path.setAttribute("d", line(link.ends.map(placeOf)));
    layer.links.style.opacity = String(1 - 0.7 * Math.sin(Math.PI * share));
    layer.beams.style.visibility = share === 0 ? "visible" : "hidden";
  };

  // --- The robots' numbers ---
  const cells = (table, signals, values, className) =>
    signals.map(([name, unit], signal) => {
      const row = html("tr", className);
      const head = html("th", "", name);
      head.scope = "row";
      const value = html("td", "p-number");
      row.append(head, value, html("td", "p-unit", unitOf(unit)));
      table.append(row);
      return { value, texts: texts(values.map((vector) => vector[signal])) };
    });
  const cards = robots.map((robot, index) => {
    const card = html("article", "p-card");
    const button = html("button");
    button.type = "button";
    const icon = svg("svg", { viewBox: "-11 -11 22 22", "aria-hidden": "true", fill: robot.color });
    icon.append(svg("path", { class: "p-body", d: robot.mark }));
    button.append(icon, html("span", "", robot.name));
    button.addEventListener("click", () => pick(index));
    card.addEventListener("pointerenter", () => point(index));
    card.addEventListener("pointerleave", () => point(null));
    const hop = html("p");
    const regions = html("p");
    const table = html("table");
    const states = cells(table, robot.states, robot.z, "");
    const inputs = cells(table, robot.inputs, robot.v, "p-input");
    card.append(button);
    if (robot.doc) card.append(html("p", "", robot.doc));
    card.append(hop, regions, table);
    byId("cards").append(card);
    return { robot, card, button, hop, regions, states, inputs };
  });
  const named = (word, names) => (names.length > 0 ? `${word} ${names.join(", ")}` : "");
  const where = (robot, step) => {
    const of = (letter) => robot.regions.filter(([, labels]) => labels[step] === letter).map(([name]) => name);
    return [named("in", of("i")), named("not in", of("o")), named("perhaps in", of("u"))];
  };
  const showCards = () => {
    const step = fold(Math.floor(now));
    for (const [index, { robot, card, button, hop, regions, states, inputs }] of cards.entries()) {
      for (const cell of [...states, ...inputs]) cell.value.textContent = cell.texts[step];
      const next = plan.hops[step][index];
      hop.replaceChildren();
      if (next) {
        hop.append("talks to ", html("b", "", nameOf(next[0])), `, ${counted(next[1], "link", "links")} to a base`);
      } else {
        hop.append(plan.links[step].length > 0 ? "no chain of links at this step" : "no links asked at this step");
      }
      const [inside, outside, unknown] = where(robot, step);
      const others = [outside, unknown].filter((words) => words).join("; ");
      regions.replaceChildren(html("b", "", inside), inside && others ? "; " : "", others);
      regions.hidden = robot.regions.length === 0;
      card.classList.toggle("p-picked", picked === index);
      button.setAttribute("aria-pressed", String(picked === index));
    }
  };

  // --- Time ---
  const slider = byId("slider");
  const phase = (step) => {
    if (step < first) return "before the loop";
    if (round === 1) return "stays for ever";
    return `round ${1 + Math.floor((step - first) / round)} of the loop`;
  };
  const showTime = () => {
    const step = Math.floor(now);
    const text = `step ${fold(step)} of ${last}, ${seconds(step)}, ${phase(step)}`;
    slider.value = String(fold(step));
    slider.setAttribute("aria-valuetext", text);
    byId("time").textContent = text;
    for (const mark of document.querySelectorAll("[data-now]")) mark.setAttribute("x", String(fold(step)));
  };
  // For those who hear the page, and only when they go step by step.
  const say = () => {
    const step = fold(Math.floor(now));
    const at = robots.map((robot) => [robot.name, where(robot, step)[0]]).filter(([, inside]) => inside);
    byId("said").textContent = [byId("time").textContent, ...at.map((words) => words.join(" "))].join(". ");
  };
  const show = () => {
    const step = Math.floor(now);
    if (step !== shownStep || focus() !== shownFocus) {
      showLinks();
      shownFocus = focus();
    }
    if (step !== shownStep) {
      showCards();
      showTime();
      shownStep = step;
    }
    place();
  };
  const again = () => {
    shownStep = -1;
    show();
  };
  const frame = (time) => {
    if (!playing) return;
    // After a pause of the whole page it goes on where it was.
    const passed = before === null ? 0 : Math.min(Math.max(time - before, 0), 250);
    before = time;
    clock += (passed / 1000) * Number(byId("speed").value);
    now = still.matches ? Math.floor(clock) : clock;
    show();
    next();
  };
  // A browser that draws nothing, busy or behind other windows, is not waited for.
  const next = () => {
    let done = false;
    const once = (time) => {
      if (!done) {
        done = true;
        frame(time);
      }
    };
    window.requestAnimationFrame(once);
    window.setTimeout(() => once(performance.now()), 100);
  };
  let clock = 0;
  const play = (wanted) => {
    if (playing === wanted) return;
    playing = wanted;
    byId("toggle").querySelector("span").textContent = playing ? "Pause" : "Play";
    byId("toggle").querySelector("path").setAttribute("d", playing ? "M3 2h4v12H3zM9 2h4v12H9z" : "M3 2l11 6-11 6z");
    clock = now;
    before = null;
    if (playing) next();
  };
  const go = (step) => {
    play(false);
    now = Math.max(0, step);
    show();
    say();
  };
  function pick(index) {
    picked = picked === index ? null : index;
    again();
  }
  function point(index) {
    pointed = index;
    show();
  }

  // --- Controls ---
  slider.max = String(last);
  slider.addEventListener("input", () => go(Number(slider.value)));
  byId("toggle").addEventListener("click", () => play(!playing));
  byId("back").addEventListener("click", () => go(Math.ceil(now) - 1));
  byId("forward").addEventListener("click", () => go(Math.floor(now) + 1));
  for (const rate of [0.25, 0.5, 1, 2, 4, 8]) {
    const option = html("option", "", `${rate} ${rate === 1 ? "step" : "steps"}/s (${Number((rate * plan.step_s).toPrecision(3))}\u00d7)`);
    option.value = String(rate);
    option.selected = rate === 1;
    byId("speed").append(option);
  }
  for (const box of document.querySelectorAll("[data-shows]")) {
    box.addEventListener("change", () => stage.classList.toggle(`no-${box.dataset.shows}`, !box.checked));
  }
  byId("runs").hidden = plan.runs === 0;
  const part = (steps, className, text) => {
    const span = html("span", className, text);
    span.style.flex = `${steps} 1 0`;
    span.title = text;
    return span;
  };
  if (first > 0) byId("parts").append(part(first, "", first === 1 ? "first: 0" : `first: 0 \u2026 ${first - 1}`));
  byId("parts").append(part(Math.max(round - 1, 0.6), "p-round", round === 1 ? `for ever: ${last}` : `then for ever: ${first} \u2026 ${last}`));
  document.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const tag = event.target.tagName;
    const takes = tag === "INPUT" || tag === "SELECT" || tag === "SUMMARY";
    if (event.key === "Escape") {
      picked = null;
      again();
    } else if (/^[1-9]$/.test(event.key) && tag !== "SELECT" && Number(event.key) <= robots.length) {
      pick(Number(event.key) - 1);
    } else if (event.key === " " && !takes && tag !== "BUTTON") {
      play(!playing);
      event.preventDefault();
    } else if (!takes && event.key === "ArrowLeft") {
      go(Math.ceil(now) - 1);
    } else if (!takes && event.key === "ArrowRight") {
      go(Math.floor(now) + 1);
    } else if (!takes && event.key === "Home") {
      go(0);
      event.preventDefault();
    } else if (!takes && event.key === "End") {
      go(last);
      event.preventDefault();
    }
  });
  // `#step=3`, `#robot=scout`, `#play`: a place in the plan that can be linked to.
  const follow = () => {
    const wanted = new URLSearchParams(window.location.hash.slice(1));
    const step = Number.parseInt(wanted.get("step"), 10);
    const robot = robots.findIndex((r) => r.name === wanted.get("robot"));
    if (robot >= 0) picked = robot;
    if (step >= 0) now = Math.min(step, last);
    again();
    if (wanted.has("play")) play(true);
  };
  window.addEventListener("hashchange", follow);

  // Everything is ready: only now is the still picture replaced.
  const legend = byId("legend").querySelector("template");
  byId("legend").append(document.importNode(legend.content, true));
  stage.setAttribute("aria-label", "The workspace with its robots");
  byId("picture").replaceChildren(stage);
  for (const id of ["controls", "now", "legend"]) byId(id).hidden = false;
  document.body.classList.add("p-live");
  // Numbers of many robots at once are too many: only the chosen one's are shown.
  document.body.classList.toggle("p-many", robots.length > 4);
  follow();
})();
