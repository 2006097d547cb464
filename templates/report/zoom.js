/* Zoom and hover for pictures with an axis of time: <svg data-zoom="left right start end">, in pixels and picoseconds.
   In g[data-plot] all x are computed anew, so that text and arrows keep their shapes; g[data-axis] gets new ticks.
   Wheel with Ctrl or with the focus, pinch, drag, double click; keys + - 0 and arrows, n and p for the boxes. */
(function () {
  "use strict";
  const NS = "http://www.w3.org/2000/svg";
  const DEEPEST = 100000, NARROWEST = 0.25;
  const UNITS = [["s", 1e12], ["ms", 1e9], ["us", 1e6], ["ns", 1e3], ["ps", 1]];
  const GLYPHS = /(^| )(head|mark|instant|alert|gap)( |$)/;
  const COORDINATES = ["x", "cx", "x1", "x2"];
  const tip = document.createElement("div");
  tip.className = "amuros-tip";
  tip.setAttribute("role", "status");
  tip.style.cssText = "position:absolute;z-index:9;max-width:24em;padding:.3em .6em;border-radius:4px;font:13px system-ui,sans-serif;" +
    "background:#1f2328;color:#fff;border:1px solid #888;pointer-events:none;visibility:hidden;left:0;top:0";

  function show(content, x, y) {
    tip.textContent = content;
    tip.style.visibility = content ? "visible" : "hidden";
    const right = document.documentElement.clientWidth - tip.offsetWidth - 8;
    tip.style.left = (content ? Math.max(4, Math.min(x + 12, right)) + window.scrollX : 0) + "px";
    tip.style.top = (content ? y + 16 + window.scrollY : 0) + "px";
  }

  function described(node, svg) {
    for (; node && node !== svg; node = node.parentNode) {
      const title = node.querySelector(":scope > title");
      if (title) return title.textContent;
    }
    return "";
  }

  function remembered(node) {
    const numbers = {};
    for (const name of COORDINATES) if (node.hasAttribute(name)) numbers[name] = +node.getAttribute(name);
    const width = node.tagName === "rect" ? +node.getAttribute("width") : null;
    const path = (node.getAttribute("d") || "").match(/[a-zA-Z][^a-zA-Z]*/g);
    return { node, numbers, width, path, isGlyph: GLYPHS.test(node.getAttribute("class") || "") };
  }

  function nice(span) {
    const power = Math.pow(10, Math.floor(Math.log10(span)));
    return [1, 2, 5, 10].map((factor) => factor * power).find((step) => step >= span);
  }

  function zoomable(svg) {
    const [left, right, start, end] = svg.dataset.zoom.split(" ").map(Number);
    const plot = svg.querySelector("g[data-plot]"), axis = svg.querySelector("g[data-axis]");
    const kept = Array.from(plot.querySelectorAll("rect,circle,line,path,text"), remembered);
    const original = Array.from(axis.childNodes);
    const boxes = Array.from(plot.querySelectorAll("rect > title"), (title) => title.parentNode);
    const pointers = new Map();
    let scale = 1, shift = 0, chosen = null, isMoved = false;

    const mapped = (x) => left + (x - left) * scale - shift;
    const time = (x) => start + (end - start) * (x - left + shift) / (right - left) / scale;

    function moved(item) {
      return item.path.map(function (part) {
        const command = part[0], values = (part.slice(1).match(/-?\d*\.?\d+/g) || []).map(Number);
        if (command === "M" || command === "L" || command === "H") values[0] = mapped(values[0]);
        if (command === "h" && !item.isGlyph) values[0] *= scale;
        return command + values.join(" ");
      }).join("");
    }

    function draw() {
      for (const item of kept) {
        for (const name in item.numbers) item.node.setAttribute(name, mapped(item.numbers[name]));
        if (item.width !== null) item.node.setAttribute("width", Math.max(item.width * scale, NARROWEST));
        if (item.path) item.node.setAttribute("d", moved(item));
      }
      axis.replaceChildren(...(scale === 1 ? original : ticks()));
    }

    function added(tag, attributes, content) {
      const node = document.createElementNS(NS, tag);
      for (const name in attributes) node.setAttribute(name, attributes[name]);
      node.textContent = content || "";
      return node;
    }

    function ticks() {
      const from = time(left), span = time(right) - from, y = +svg.dataset.axis;
      const [name, unit] = UNITS.find((each) => span >= 2 * each[1]) || UNITS[4];
      const step = Math.max(1, nice(span * 110 / (right - left)));
      const places = Math.max(0, Math.ceil(-Math.log10(step / unit)));
      const found = [added("path", { class: "rule", d: "M" + left + " " + y + "H" + right })];
      for (let at = Math.ceil(from / step) * step; at <= from + span; at += step) {
        const x = left + (at - from) / span * (right - left);
        found.push(added("line", { class: "rule", x1: x, x2: x, y1: y, y2: y + 5 }));
        found.push(added("text", { class: "small", x, y: y + 17, "text-anchor": "middle" }, (at / unit).toFixed(places)));
      }
      const caption = { class: "small muted", x: (left + right) / 2, y: y + 34, "text-anchor": "middle" };
      return [...found, added("text", caption, "time in " + name)];
    }

    function change(factor, x, by) {
      const before = (x - left + shift) / scale;
      scale = Math.min(Math.max(scale * factor, 1), DEEPEST);
      shift = Math.min(Math.max(before * scale - (x - left) - by, 0), (right - left) * (scale - 1));
      requestAnimationFrame(draw);
    }

    function reset() {
      scale = 1;
      shift = 0;
      requestAnimationFrame(draw);
    }

    function place(event) {
      const frame = svg.getBoundingClientRect();
      return (event.clientX - frame.left) * svg.viewBox.baseVal.width / frame.width;
    }

    function step(by) {
      const seen = boxes.filter((box) => +box.getAttribute("x") < right && +box.getAttribute("x") + +box.getAttribute("width") > left);
      if (!seen.length) return;
      const at = seen.indexOf(chosen);
      chosen = seen[(at < 0 && by < 0 ? seen.length - 1 : at + by + seen.length) % seen.length];
      const frame = chosen.getBoundingClientRect();
      show(described(chosen, svg), frame.left, frame.bottom);
    }

    const middle = (left + right) / 2, far = (right - left) / 8;
    const keys = {
      "+": () => change(1.5, middle, 0), "=": () => change(1.5, middle, 0), "-": () => change(1 / 1.5, middle, 0), "0": reset,
      ArrowLeft: () => change(1, middle, far), ArrowRight: () => change(1, middle, -far), n: () => step(1), p: () => step(-1),
      Escape: () => show("", 0, 0),
    };

    function drag(event) {
      const x = place(event), was = pointers.get(event.pointerId);
      if (!isMoved && Math.abs(x - was) < 3) return;
      if (!isMoved) svg.setPointerCapture(event.pointerId);
      isMoved = true;
      const other = Array.from(pointers).find((each) => each[0] !== event.pointerId);
      pointers.set(event.pointerId, x);
      if (other) change(Math.abs(x - other[1]) / Math.max(Math.abs(was - other[1]), 1), other[1], 0);
      else change(1, x, x - was);
    }

    svg.setAttribute("tabindex", "0");
    svg.style.touchAction = "pan-y";
    svg.addEventListener("keydown", function (event) {
      if (event.ctrlKey || event.metaKey || event.altKey || !keys[event.key]) return;
      event.preventDefault();
      keys[event.key]();
    });
    svg.addEventListener("wheel", function (event) {
      if (!event.ctrlKey && document.activeElement !== svg) return;
      event.preventDefault();
      change(Math.pow(2, -event.deltaY / 240), place(event), 0);
    }, { passive: false });
    svg.addEventListener("pointerdown", function (event) { pointers.set(event.pointerId, place(event)); isMoved = false; });
    svg.addEventListener("pointermove", function (event) {
      if (pointers.has(event.pointerId)) drag(event);
      else show(described(event.target, svg), event.clientX, event.clientY);
    });
    for (const name of ["pointerup", "pointercancel"]) svg.addEventListener(name, (event) => pointers.delete(event.pointerId));
    for (const name of ["pointerleave", "blur"]) svg.addEventListener(name, () => show("", 0, 0));
    svg.addEventListener("dblclick", reset);
  }

  document.body.append(tip);
  document.querySelectorAll("svg[data-zoom]").forEach(zoomable);
})();
