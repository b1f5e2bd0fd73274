/* Form and drawings of the page: numbers come from the server by trame's state, what is done goes there by triggers. */
(function () {
  "use strict";
  const RPM = 30 / Math.PI;
  const STEPS = 1000; // of a slider
  const WET = "#0072b2", DRY = "#d55e00";
  // After Okabe and Ito, each with dashes of its own.
  const FROZEN = [["#009e73", "10 3 2 3"], ["#cc79a7", "2 3"], ["#8a6d00", "12 4"], ["#56b4e9", "4 2"], ["#555555", "1 3"]];
  const DRAWN = 0.22; // largest deflection as drawn over the wall's radius
  const BEAT = 2000; // ms between looks whether the server is there

  let trame, curve = null, compared = { frozen: [], measured: null }, form = null, fault = { text: "", path: "" };
  let cursor = null, log = false, marks = 0, dragging = null, stale = false;
  const sent = new Map(), rows = new Map(), me = Math.random().toString(36).slice(2, 8);

  const at = (id) => document.getElementById(id);
  const escape = (text) => String(text).replace(/[&<>"]/g, (c) => ({ "&": "&amp;", "<": "&lt;", ">": "&gt;", '"': "&quot;" })[c]);
  const four = (x) => (x === 0 ? "0" : Math.abs(x) >= 1e5 || Math.abs(x) < 1e-4 ? x.toExponential(3) : String(Number(x.toPrecision(4))));
  const call = (name, ...given) => trame.trigger(name, given).catch(() => gone(true));

  function element(name, given = {}, ...inside) {
    const made = document.createElement(name);
    for (const [key, value] of Object.entries(given)) {
      if (key in made && key !== "list") made[key] = value;
      else made.setAttribute(key, value);
    }
    made.append(...inside.filter((one) => one !== null));
    return made;
  }

  /* The form. */

  function toSlider(s, value) {
    const share = s.log ? Math.log(value / s.low) / Math.log(s.high / s.low) : (value - s.low) / (s.high - s.low);
    return Math.round(STEPS * Math.min(1, Math.max(0, share)));
  }

  function fromSlider(field, place) {
    const s = field.slider, share = place / STEPS;
    const value = s.log ? s.low * Math.pow(s.high / s.low, share) : s.low + share * (s.high - s.low);
    if (field.kind === "whole") return String(Math.round(value));
    const text = String(Number(value.toPrecision(4)));
    return field.unit ? `${text} ${field.unit}` : text;
  }

  function send(name, field, text) {
    const mark = `${me}:${++marks}`;
    sent.set(mark, performance.now());
    if (sent.size > 500) sent.clear();
    return call(name, field.path, text, mark);
  }

  function makeRow(field) {
    const id = `field-${field.path}`;
    const row = { field, box: null, slider: null, fault: element("div", { className: "fault", role: "alert", hidden: true }) };
    const about = `${field.help}${field.help ? "; " : ""}${field.allowed}`;
    let list = null;
    if (field.kind === "choice") {
      row.box = element("select", { id, title: about });
    } else if (field.kind === "flag") {
      row.box = element("input", { id, type: "checkbox", title: about });
    } else {
      row.box = element("input", { id, type: "text", title: about, autocomplete: "off", spellcheck: false });
      if (field.choices.length) {
        list = element("datalist", { id: `${id}-names` }, ...field.choices.map((name) => element("option", { value: name })));
        row.box.setAttribute("list", list.id);
      }
    }
    row.box.addEventListener("change", () => {
      const text = field.kind === "flag" ? String(row.box.checked) : row.box.value;
      if (text !== row.field.text || row.div.classList.contains("wrong")) send("edit", row.field, text);
    });
    const label = element("label", { htmlFor: id, title: about }, field.label);
    if (field.assumed) label.append(element("span", { className: "assumed", title: "no source gives this value" }, "assumed"));
    row.div = element("div", { className: field.slider ? "field" : "field plain" }, label, row.box, list);
    row.div.dataset.path = field.path;
    if (field.slider) {
      row.slider = element("input", { type: "range", min: 0, max: STEPS, step: 1 });
      row.slider.setAttribute("aria-label", `${field.label}, slider`);
      row.slider.addEventListener("input", () => {
        dragging = field.path;
        row.box.value = fromSlider(row.field, Number(row.slider.value));
        row.slider.setAttribute("aria-valuetext", row.box.value);
        send("drag", row.field, row.box.value);
      });
      row.slider.addEventListener("change", () => {
        dragging = null;
        send("edit", row.field, fromSlider(row.field, Number(row.slider.value)));
      });
      row.div.append(row.slider);
    }
    row.div.append(row.fault);
    fill(row, field);
    return row;
  }

  function fill(row, field) {
    row.field = field;
    if (dragging === field.path) return;
    if (field.kind === "choice") {
      const names = field.choices.includes(field.text) || !field.text ? field.choices : [...field.choices, field.text];
      const first = element("option", { value: "" }, field.usual ? `(${field.usual})` : "(not given)");
      row.box.replaceChildren(first, ...names.map((name) => element("option", { value: name }, name)));
      row.box.value = field.text;
    } else if (field.kind === "flag") {
      row.box.checked = (field.text || field.usual) === "true";
    } else {
      row.box.value = field.text;
      row.box.placeholder = field.usual;
    }
    if (row.slider && field.slider) {
      row.slider.value = toSlider(field.slider, field.slider.at);
      row.slider.setAttribute("aria-valuetext", field.text || field.usual);
    }
  }

  const shape = (given) => JSON.stringify(given.groups.map((g) => g.sets.map((s) => [s.title, s.fields.map((f) => [f.path, !!f.slider, f.assumed])])));

  function showForm(given) {
    if (!given || !given.groups.length) return;
    const fresh = form === null || shape(form) !== shape(given);
    form = given;
    if (!fresh) {
      for (const g of given.groups) for (const s of g.sets) for (const f of s.fields) fill(rows.get(f.path), f);
      return;
    }
    const focus = document.activeElement && document.activeElement.closest(".field");
    const kept = focus && [focus.dataset.path, document.activeElement.type];
    const opened = new Map([...document.querySelectorAll("#form details")].map((one) => [one.dataset.name, one.open]));
    const was = (name, usual) => (opened.has(name) ? opened.get(name) : usual);
    rows.clear();
    const groups = given.groups.map((group) => {
      const box = element("details", { className: "group", open: was(group.title, !["Run-up", "Model"].includes(group.title)) });
      box.dataset.name = group.title;
      box.append(element("summary", {}, group.title));
      group.sets.forEach((set, k) => {
        const name = `${group.title}/${set.title}/${k}`;
        const part = element("details", { className: "set", open: was(name, !set.title.includes(",")) });
        part.dataset.name = name;
        part.append(element("summary", {}, set.title || "Surroundings"));
        const rest = [];
        for (const field of set.fields) {
          const row = makeRow(field);
          rows.set(field.path, row);
          if (field.text) part.append(row.div);
          else rest.push(row.div);
        }
        if (rest.length) {
          const more = element("details", { className: "more", open: was(`${name}/more`, false) });
          more.dataset.name = `${name}/more`;
          more.append(element("summary", {}, `${rest.length} more that the file leaves to their usual values`), ...rest);
          part.append(more);
        }
        box.append(part);
      });
      return box;
    });
    at("form").replaceChildren(...groups);
    if (kept && rows.has(kept[0])) {
      const row = rows.get(kept[0]);
      (kept[1] === "range" && row.slider ? row.slider : row.box).focus();
    }
    showFault(fault);
  }

  function showFault(given) {
    fault = given || { text: "", path: "" };
    for (const [path, row] of rows) {
      const wrong = path === fault.path && fault.text !== "";
      row.div.classList.toggle("wrong", wrong);
      row.fault.hidden = !wrong;
      row.fault.textContent = wrong ? fault.text : "";
      row.box.setAttribute("aria-invalid", String(wrong));
      if (wrong) for (let up = row.div.parentElement; up && up.id !== "form"; up = up.parentElement) if (up.tagName === "DETAILS") up.open = true;
    }
  }

  /* The curve. */

  function ticks(low, high, count) {
    const raw = (high - low) / count, power = Math.pow(10, Math.floor(Math.log10(raw)));
    const step = [1, 2, 5, 10].map((x) => x * power).find((x) => x >= raw * 0.999);
    const found = [];
    for (let k = Math.ceil(low / step - 1e-9); k * step <= high * (1 + 1e-12) + 1e-300; k++) found.push(k * step);
    return found;
  }

  function path(xs, ys, X, Y, keep) {
    let text = "", pen = false;
    for (let k = 0; k < xs.length; k++) {
      const y = ys[k] === null || (log && ys[k] <= 0) ? null : Y(ys[k]);
      if (y === null || xs[k] === null || (keep && !keep(k))) { pen = false; continue; }
      text += `${pen ? "L" : "M"}${X(xs[k]).toFixed(1)} ${y.toFixed(1)}`;
      pen = true;
    }
    return text;
  }

  function skeleton() {
    at("chart").innerHTML =
      '<svg role="img" aria-label="Amplitude over speed"></svg>' +
      '<input id="cursor" type="range" min="0" max="1000" step="1" value="500" aria-label="Speed of the cursor">' +
      '<div class="bar"><output id="reading" for="cursor"></output><label><input id="log" type="checkbox"> logarithmic</label></div>' +
      '<div class="bar key" id="key"></div>';
    at("cursor").addEventListener("input", () => {
      const [low, high] = span();
      cursor = low + (high - low) * Number(at("cursor").value) / 1000;
      draw();
    });
    at("log").addEventListener("change", () => { log = at("log").checked; draw(); });
    const svg = at("chart").querySelector("svg");
    const move = (event) => {
      if (!curve || (event.type === "pointermove" && !event.buttons)) return;
      const box = svg.getBoundingClientRect(), { left, right, width } = room();
      const share = ((event.clientX - box.left) * width / box.width - left) / (width - left - right);
      at("cursor").value = Math.round(1000 * Math.min(1, Math.max(0, share)));
      at("cursor").dispatchEvent(new Event("input"));
    };
    svg.addEventListener("pointerdown", move);
    svg.addEventListener("pointermove", move);
    let wide = 0;
    new ResizeObserver(() => requestAnimationFrame(() => {
      const now = at("chart") ? at("chart").clientWidth : wide;
      if (now !== wide) { wide = now; draw(); }
    })).observe(at("chart"));
  }

  const span = () => [curve.speed[0], curve.speed[curve.speed.length - 1]];

  function room() {
    const width = Math.max(300, at("chart").clientWidth), small = width < 500;
    return { width, height: small ? 200 : Math.min(380, Math.max(260, 0.5 * innerHeight)), left: 56, right: 20, top: 10, bottom: 40 };
  }

  function nearest(speed) {
    let best = 0;
    curve.speed.forEach((one, k) => { if (Math.abs(one - speed) < Math.abs(curve.speed[best] - speed)) best = k; });
    return best;
  }

  const mm = (value) => (value === null || value === undefined ? "not found" : `${four(1e3 * value)} mm`);

  function others() {
    const found = compared.frozen.map((one, k) => ({ ...one, colour: FROZEN[k % 5][0], dash: FROZEN[k % 5][1] }));
    return found;
  }

  function draw() {
    const svg = at("chart") && at("chart").querySelector("svg");
    if (!svg) return;
    if (!curve) { svg.innerHTML = ""; at("section").innerHTML = ""; return; }
    const { width, height, left, right, top, bottom } = room();
    let [low, high] = span();
    if (low === high) { low *= 0.9; high *= 1.1; }
    const extra = [...others(), ...(compared.measured ? [compared.measured] : [])];
    const inside = (one) => one.amplitude.filter((a, k) => a !== null && one.speed[k] >= low && one.speed[k] <= high);
    const known = [curve.amplitude, curve.dry].flat().filter((a) => a !== null).concat(extra.flatMap(inside)).filter((a) => a > 0);
    const most = known.length ? Math.max(...known) * 1.05 : 1e-3, least = log && known.length ? Math.max(Math.min(...known), most * 1e-5) * 0.9 : 0;
    const X = (w) => left + (w - low) / (high - low) * (width - left - right);
    const share = (a) => (log ? Math.log(Math.max(a, least * 0.5) / least) / Math.log(most / least) : a / most);
    const Y = (a) => top + (1 - share(a)) * (height - top - bottom);
    const floor = height - bottom;
    let text = '<defs><pattern id="hatch" width="6" height="6" patternTransform="rotate(45)" patternUnits="userSpaceOnUse">' +
      '<rect width="6" height="6" fill="#f6e6f0"/><line x1="0" y1="0" x2="0" y2="6" stroke="#aa3377" stroke-width="1.2"/></pattern>' +
      `<clipPath id="inside"><rect x="${left}" y="${top}" width="${width - left - right}" height="${floor - top}"/></clipPath></defs>`;
    for (const [from, to] of curve.bands) {
      const a = X(Math.max(from, low)), b = X(Math.min(to, high));
      if (b > a) text += `<rect class="band" x="${a}" y="${top}" width="${b - a}" height="${floor - top}" fill="url(#hatch)" opacity="0.55"/>`;
    }
    for (const rpm of ticks(low * RPM, high * RPM, width < 500 ? 4 : 8)) {
      const x = X(rpm / RPM);
      text += `<line x1="${x}" y1="${top}" x2="${x}" y2="${floor}" stroke="#e2e2e2"/><text x="${x}" y="${floor + 15}" text-anchor="middle">${four(rpm)}</text>`;
    }
    const decades = Array.from({ length: 12 }, (_, n) => Math.pow(10, n - 10));
    const wide = most / least > 300;
    const levels = log ? decades.flatMap((a) => (wide ? [a] : [a, 2 * a, 5 * a])).filter((a) => a >= least && a <= most) : ticks(0, most * 1e3, 5).map((a) => a / 1e3);
    for (const a of levels) {
      text += `<line x1="${left}" y1="${Y(a)}" x2="${width - right}" y2="${Y(a)}" stroke="#e2e2e2"/><text x="${left - 5}" y="${Y(a) + 4}" text-anchor="end">${four(a * 1e3)}</text>`;
    }
    text += `<text x="${(left + width - right) / 2}" y="${height - 6}" text-anchor="middle">Speed (rpm)</text>`;
    text += `<text transform="translate(12 ${(top + floor) / 2}) rotate(-90)" text-anchor="middle">Amplitude (mm 0-p)</text>`;
    text += `<rect x="${left}" y="${top}" width="${width - left - right}" height="${floor - top}" fill="none" stroke="#666"/><g clip-path="url(#inside)" fill="none">`;
    for (const one of others()) text += `<path d="${path(one.speed, one.amplitude, X, Y)}" stroke="${one.colour}" stroke-width="1.6" stroke-dasharray="${one.dash}"/>`;
    text += `<path id="dry" d="${path(curve.speed, curve.dry, X, Y)}" stroke="${DRY}" stroke-width="1.6" stroke-dasharray="7 4"/>`;
    const unstable = new Set(curve.unstable);
    const bad = curve.speed.map((w) => unstable.has(w) || curve.bands.some(([a, b]) => w >= a && w <= b));
    if (curve.chambers.length) {
      text += `<path id="wet" d="${path(curve.speed, curve.amplitude, X, Y)}" stroke="${WET}" stroke-width="1.2"/>`;
      text += `<path d="${path(curve.speed, curve.amplitude, X, Y, (k) => !bad[k] && curve.in_range[k])}" stroke="${WET}" stroke-width="2.6"/>`;
    }
    if (compared.measured) {
      const m = compared.measured;
      m.speed.forEach((w, k) => { if (m.amplitude[k] !== null) text += `<circle class="measured" cx="${X(w)}" cy="${Y(m.amplitude[k])}" r="3" stroke="#000" fill="#fff"/>`; });
    }
    if (cursor === null) cursor = high;
    cursor = Math.min(high, Math.max(low, cursor));
    const k = nearest(cursor);
    text += `<line id="line" x1="${X(cursor)}" y1="${top}" x2="${X(cursor)}" y2="${floor}" stroke="#000"/>`;
    if (curve.amplitude[k] !== null && curve.chambers.length) text += `<circle cx="${X(curve.speed[k])}" cy="${Y(curve.amplitude[k])}" r="4" fill="${WET}"/>`;
    svg.setAttribute("viewBox", `0 0 ${width} ${height}`);
    svg.setAttribute("font-size", "12");
    svg.innerHTML = text + "</g>";
    at("cursor").value = Math.round(1000 * (cursor - low) / (high - low));
    const reading = `${four(cursor * RPM)} rpm: ${curve.chambers.length ? `with liquid ${mm(curve.amplitude[k])}, without` : "amplitude"} ${mm(curve.dry[k])}${bad[k] ? "; unstable" : ""}`;
    at("reading").textContent = reading;
    at("cursor").setAttribute("aria-valuetext", reading);
    drawKey();
    drawSection(k);
  }

  function drawKey() {
    const line = (colour, dash, name, thick) => `<span><svg viewBox="0 0 26 10" aria-hidden="true"><line x1="0" y1="5" x2="26" y2="5" stroke="${colour}" stroke-width="${thick}" stroke-dasharray="${dash}"/></svg> ${escape(name)}</span>`;
    let text = curve.chambers.length ? line(WET, "", "with liquid (thin: unstable or out of range)", 2.6) : "";
    text += line(DRY, "7 4", "without liquid", 1.6);
    for (const one of others()) text += line(one.colour, one.dash, one.name, 1.6);
    if (compared.measured) text += `<span><svg viewBox="0 0 26 10" aria-hidden="true"><circle cx="13" cy="5" r="3" fill="#fff" stroke="#000"/></svg> ${escape(compared.measured.name)}</span>`;
    if (curve.bands.length) text += '<span><svg viewBox="0 0 26 10" aria-hidden="true"><rect width="26" height="10" fill="url(#hatch)"/></svg> self-excited whirl</span>';
    if (at("key").innerHTML !== text) at("key").innerHTML = text;
  }

  /* The chamber's section: the surface is the circle about the axis of rotation that leaves the area of the liquid. */

  function lens(R, r, d) {
    if (d >= R + r) return 0;
    if (d <= Math.abs(R - r)) return Math.PI * Math.min(R, r) ** 2;
    const a = Math.acos((d * d + R * R - r * r) / (2 * d * R)), b = Math.acos((d * d + r * r - R * R) / (2 * d * r));
    return R * R * (a - Math.sin(2 * a) / 2) + r * r * (b - Math.sin(2 * b) / 2);
  }

  function solved(f, low, high) {
    for (let k = 0; k < 50; k++) { const mid = (low + high) / 2; if (f(mid) > 0) low = mid; else high = mid; }
    return (low + high) / 2;
  }

  function factor() {
    let found = Infinity;
    curve.chambers.forEach((c, j) => {
      const depth = c.radius - Math.sqrt(Math.max(0, c.radius ** 2 - c.area / Math.PI));
      const size = Math.max(0, ...curve.real[j].map((x, k) => (x === null ? 0 : Math.hypot(x, curve.imag[j][k]))));
      if (size > 0) found = Math.min(found, DRAWN * c.radius / size);
      if (depth > 0) found = Math.min(found, Math.max(1, 0.4 * (c.radius - c.inner) / depth));
    });
    if (!isFinite(found)) return 1;
    const step = Math.pow(10, Math.floor(Math.log10(found)) - 1);
    return Math.floor(found / step * (1 + 1e-9)) * step;
  }

  function drawSection(k) {
    if (!curve.chambers.length) { at("section").innerHTML = ""; return; }
    const f = factor(), shown = curve.chambers.slice(0, 3), size = 180;
    const widest = Math.max(...shown.map((c) => c.radius)), unit = 74 / widest;
    let text = "", dry = [];
    const still = curve.horizontal && curve.capture !== null && curve.speed[k] < curve.capture;
    shown.forEach((c, j) => {
      const x0 = size * (j + 0.5), y0 = size / 2, R = c.radius, n = `chamber ${j + 1}`;
      const w = still || curve.real[j][k] === null ? [0, 0] : [f * curve.real[j][k], f * curve.imag[j][k]];
      const d = Math.hypot(...w), cx = x0 + unit * w[0], cy = y0 - unit * w[1];
      text += `<clipPath id="wall${j}"><circle cx="${cx}" cy="${cy}" r="${unit * R}"/></clipPath>`;
      if (!c.round) {
        text += `<circle cx="${cx}" cy="${cy}" r="${unit * R}" fill="#eee" stroke="#444"/><text x="${x0}" y="${y0}" text-anchor="middle">section from a file</text>`;
      } else if (c.area <= 0) {
        text += `<circle cx="${cx}" cy="${cy}" r="${unit * R}" fill="#fff" stroke="#222" stroke-width="2"/>`;
      } else if (still) {
        const level = solved((h) => R * R * (Math.acos(h / R) - h / R * Math.sqrt(1 - (h / R) ** 2)) - c.area, -R, R);
        text += `<circle cx="${cx}" cy="${cy}" r="${unit * R}" fill="#fff"/><rect clip-path="url(#wall${j})" x="0" y="${y0 + unit * level}" width="${3 * size}" height="${size}" fill="#56b4e9"/><circle cx="${cx}" cy="${cy}" r="${unit * R}" fill="none" stroke="#222" stroke-width="2"/>`;
      } else {
        const depth = R - Math.sqrt(Math.max(0, R * R - c.area / Math.PI)), drawn = Math.min(f > 1 ? f * depth : depth, Math.max(depth, 0.9 * (R - c.inner)));
        const area = Math.PI * drawn * (2 * R - drawn);
        const r = solved((s) => Math.PI * R * R - lens(R, s, d) - area, 0, R + d);
        if (r + d > R * (1 + 1e-9)) dry.push(n);
        text += `<circle class="liquid" cx="${cx}" cy="${cy}" r="${unit * R}" fill="#56b4e9"/><circle class="surface" clip-path="url(#wall${j})" cx="${x0}" cy="${y0}" r="${unit * r}" fill="#fff" stroke="${WET}"/><circle cx="${cx}" cy="${cy}" r="${unit * R}" fill="none" stroke="#222" stroke-width="2"/>`;
      }
      if (c.inner > 0) text += `<circle cx="${cx}" cy="${cy}" r="${unit * c.inner}" fill="#ddd" stroke="#222"/>`;
      text += `<path d="M${x0 - 5} ${y0}h10M${x0} ${y0 - 5}v10" stroke="#000"/><circle class="centre" cx="${cx}" cy="${cy}" r="3" fill="${DRY}"/>`;
      if (!still) text += `<circle cx="${cx + unit * R * 1.07}" cy="${cy}" r="4" fill="#222"/>`;
    });
    const more = curve.chambers.length > 3 ? ` ${curve.chambers.length - 3} more chambers are like these.` : "";
    const words = still
      ? `${four(curve.speed[k] * RPM)} rpm: below ${four(curve.capture * RPM)} rpm gravity keeps the liquid at the bottom.${more}`
      : `${four(curve.speed[k] * RPM)} rpm, ${f === 1 ? "to scale" : `deflection and depth ${four(f)} times`}. Cross: axis of rotation; dot: axis of the drum; black: unbalance.${dry.length ? ` Wall dry in part as drawn: ${dry.join(", ")}.` : ""}${more}`;
    at("section").innerHTML = `<svg viewBox="0 0 ${size * shown.length} ${size}" font-size="11" style="max-height:${size + 40}px" role="img" aria-label="Chambers seen along the axis">${text}</svg><p>${escape(words)}</p>`;
  }

  /* Words and work. */

  function showWords(given) {
    if (!given) return;
    stale = false;
    at("words").classList.remove("stale");
    let text = `<h2 id="headline">${escape(given.headline || "Working ...")}</h2>`;
    if (given.error) text += `<p>Estimated error: ${escape(given.error)}</p>`;
    for (const one of given.cautions) text += `<p class="caution">Caution: ${escape(one)}</p>`;
    for (const table of given.tables) {
      if (table.title) text += `<h3>${escape(table.title)}</h3>`;
      text += "<table>" + (table.head.length ? `<tr>${table.head.map((cell) => `<th scope="col">${escape(cell)}</th>`).join("")}</tr>` : "");
      text += table.rows.map((row) => `<tr>${row.map((cell, k) => (k ? `<td>${escape(cell)}</td>` : `<th scope="row">${escape(cell)}</th>`)).join("")}</tr>`).join("") + "</table>";
    }
    if (given.notes.length) text += `<details><summary>${given.notes.length} notes</summary>${given.notes.map((one) => `<p>${escape(one)}</p>`).join("")}</details>`;
    at("words").innerHTML = text;
  }

  function showCurve(given) {
    if (!given) return;
    curve = given.curve;
    if (!stale && given.mark) { stale = true; at("words").classList.add("stale"); }
    draw();
    const begun = sent.get(given.mark);
    if (begun === undefined) return;
    for (const mark of [...sent.keys()]) { sent.delete(mark); if (mark === given.mark) break; }
    requestAnimationFrame(() => dispatchEvent(new CustomEvent("leblanc:drawn", { detail: { mark: given.mark, ms: performance.now() - begun } })));
  }

  function plot(xs, ys, xname, yname) {
    const w = 600, h = 240, X0 = 56, top = 10, floor = h - 36, high = Math.max(...ys.filter((y) => y !== null)) * 1.05 || 1;
    const X = (x) => X0 + (x - xs[0]) / (xs[xs.length - 1] - xs[0]) * (w - X0 - 10), Y = (y) => floor - y / high * (floor - top);
    const kept = log;
    log = false;
    let text = `<svg viewBox="0 0 ${w} ${h}" font-size="12" role="img" aria-label="${escape(yname)} over ${escape(xname)}"><rect x="${X0}" y="${top}" width="${w - X0 - 10}" height="${floor - top}" fill="none" stroke="#666"/>`;
    for (const x of ticks(xs[0], xs[xs.length - 1], 6)) text += `<text x="${X(x)}" y="${floor + 15}" text-anchor="middle">${four(x)}</text>`;
    for (const y of ticks(0, high, 4)) text += `<text x="${X0 - 5}" y="${Y(y) + 4}" text-anchor="end">${four(y)}</text>`;
    text += `<path d="${path(xs, ys, X, Y)}" fill="none" stroke="${WET}"/><text x="${w / 2}" y="${h - 4}" text-anchor="middle">${escape(xname)}</text><text transform="translate(12 ${h / 2}) rotate(-90)" text-anchor="middle">${escape(yname)}</text></svg>`;
    log = kept;
    return text;
  }

  function drawMap(box, r) {
    const w = 600, h = 300, left = 60, top = 8, right = 24, bottom = 40;
    const canvas = element("canvas", { width: w, height: h, role: "img" });
    canvas.setAttribute("aria-label", "Growth rate over speed and volume");
    const pen = canvas.getContext("2d"), nx = r.speed.length, ny = r.volume.length;
    const most = Math.max(1e-12, ...r.growth.flat().filter((g) => g !== null).map(Math.abs));
    const cw = (w - left - right) / nx, ch = (h - top - bottom) / ny;
    r.growth.forEach((line, j) => line.forEach((g, i) => {
      const s = g === null ? 0 : Math.sqrt(Math.min(1, Math.abs(g) / most));
      // Orange grows, blue decays; both fade to white at the boundary.
      const [a, b, c] = g === null ? [210, 210, 210] : g > 0 ? [255 - 42 * s, 255 - 161 * s, 255 - 255 * s] : [255 - 255 * s, 255 - 141 * s, 255 - 77 * s];
      pen.fillStyle = `rgb(${a | 0},${b | 0},${c | 0})`;
      pen.fillRect(left + i * cw, h - bottom - (j + 1) * ch, cw + 1, ch + 1);
    }));
    pen.fillStyle = "#222";
    pen.font = "12px sans-serif";
    pen.textAlign = "center";
    const low = r.speed[0] * RPM, high = r.speed[nx - 1] * RPM, full = r.volume[ny - 1] * 1e6;
    for (const t of ticks(low, high, 6)) pen.fillText(four(t), left + (t - low) / (high - low) * (w - left - right), h - bottom + 14);
    pen.fillText("Speed (rpm)", (left + w) / 2, h - 6);
    pen.textAlign = "right";
    for (const t of ticks(0, full, 4)) pen.fillText(four(t), left - 5, h - bottom - t / full * (h - top - bottom) + 4);
    pen.save(); pen.translate(12, h / 2); pen.rotate(-Math.PI / 2); pen.textAlign = "center"; pen.fillText("Liquid (ml)", 0, 0); pen.restore();
    const y = h - bottom - r.scene_volume * 1e6 / full * (h - top - bottom);
    pen.setLineDash([6, 3]);
    pen.beginPath(); pen.moveTo(left, y); pen.lineTo(w - right, y); pen.stroke();
    box.append(canvas, element("p", {}, "Orange: whirl grows by itself; blue: it decays; dashed: this machine's liquid."));
    r.notes.slice(0, 2).forEach((one) => box.append(element("p", {}, one)));
  }

  const shownOf = new Map();

  function showJobs(jobs) {
    requestAnimationFrame(() => {
      for (const job of jobs || []) {
        const box = document.querySelector(`#job-${job.kind} .lb-result`);
        if (!box) continue;
        const what = job.state + JSON.stringify(job.result || 0).length;
        if (shownOf.get(job.kind) === what && box.childNodes.length) continue;
        shownOf.set(job.kind, what);
        box.replaceChildren();
        if (job.state === "done") showResult(box, job.kind, job.result);
      }
    });
  }

  async function showResult(box, kind, r) {
    if (kind === "runup") {
      box.innerHTML = plot(r.time, r.amplitude.map((a) => (a === null ? null : a * 1e3)), "Time (s)", "Amplitude (mm 0-p)") + `<p>Largest: ${mm(r.peak.amplitude)} at ${four(r.peak.speed * RPM)} rpm.</p>`;
    } else if (kind === "map") {
      drawMap(box, r);
    } else if (kind === "best") {
      const text = (r.volume || []).map((v, k) => `chamber ${k + 1}: ${four(v * 1e6)} ml`).join(", ");
      box.append(element("p", {}, `${r.meaning}: ${mm(r.vibration)} with ${text}; ${mm(r.vibration_baseline)} without liquid.`));
      const use = element("button", { type: "button", id: "take-best", className: "v-btn v-btn--variant-tonal v-btn--size-small" }, "Use these volumes");
      use.style.padding = "2px 10px";
      use.style.border = "1px solid #888";
      use.addEventListener("click", () => call("take_best"));
      box.append(use);
    } else {
      const file = await call("content", kind);
      if (!file) return;
      const bytes = Uint8Array.from(atob(file.data), (c) => c.charCodeAt(0));
      const address = URL.createObjectURL(new Blob([bytes], { type: file.type }));
      if (file.type.startsWith("image/")) box.append(element("img", { src: address, alt: kind === "view" ? "The machine in three dimensions" : "Film of the machine" }));
      box.append(element("p", {}, element("a", { href: address, download: file.name, className: "lb-download" }, `Save ${file.name}`)));
    }
  }

  function save() {
    if (form === null) return;
    const link = element("a", { href: URL.createObjectURL(new Blob([form.text], { type: "application/toml" })), download: form.file });
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 1000);
  }

  function pick(what) {
    const input = element("input", { type: "file", accept: what === "open" ? ".toml" : ".csv,.txt,.tsv", id: `pick-${what}` });
    input.hidden = true;
    input.addEventListener("change", async () => {
      const file = input.files[0];
      if (file) await call(what, file.name, await file.text());
      input.remove();
    });
    document.body.append(input);
    input.click();
  }

  let lost = false;

  // trame takes its whole page away where the connection is lost: what is said then stands outside it.
  function gone(is) {
    if (is === lost) return;
    lost = is;
    if (at("gone")) at("gone").remove();
    if (!is) return;
    const button = element("button", { type: "button" }, "Save the machine");
    button.addEventListener("click", save);
    const text = "The server does not answer: start leblanc app again and open its new address. ";
    document.body.append(element("div", { id: "gone", className: "lb-gone", role: "alert" }, text, button));
  }

  async function beat() {
    const late = new Promise((_, no) => setTimeout(() => no(new Error("late")), 3 * BEAT));
    try {
      await Promise.race([trame.trigger("alive", []), late]);
      gone(false);
    } catch {
      gone(true);
    }
    setTimeout(beat, BEAT);
  }

  /* Buttons that need more than a trigger. */
  function pressed(event) {
    const button = event.target.closest && event.target.closest(".lb-tools button");
    if (!button) return;
    if (button.id === "save") save();
    else if (button.id === "open") pick("open");
    else if (button.id === "measure") pick("measured");
    else if (button.id.startsWith("start-")) call("start", button.id.slice("start-".length), cursor);
  }

  function begin() {
    trame = window.trame;
    if (!trame || !trame.state || !at("form") || !at("chart") || !at("words")) { setTimeout(begin, 30); return; }
    skeleton();
    trame.state.watch(["form"], showForm);
    trame.state.watch(["said"], showFault);
    trame.state.watch(["compared"], (given) => { if (given) { compared = given; draw(); } });
    trame.state.watch(["curve"], showCurve);
    trame.state.watch(["words"], showWords);
    trame.state.watch(["jobs"], showJobs);
    document.addEventListener("click", pressed);
    addEventListener("keydown", (event) => {
      const typing = ["INPUT", "SELECT", "TEXTAREA"].includes(event.target.tagName) && event.target.type === "text";
      if ((event.ctrlKey || event.metaKey) && event.key.toLowerCase() === "z" && !typing) {
        event.preventDefault();
        call(event.shiftKey ? "redo" : "undo");
      }
    });
    beat();
  }
  begin();
})();
