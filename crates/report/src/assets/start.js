"use strict";
// Dark or light: as the system says, until the reader chooses.
const theme = (function () {
  const dark = window.matchMedia("(prefers-color-scheme: dark)");
  const listeners = [];
  let chosen = null;
  function isDark() { return chosen === null ? dark.matches : chosen === "dark"; }
  function apply() {
    document.documentElement.dataset.theme = isDark() ? "dark" : "light";
    for (const listener of listeners) listener();
  }
  dark.addEventListener("change", apply);
  const button = document.createElement("button");
  button.type = "button";
  button.id = "theme";
  button.textContent = "◐";
  button.title = "dark or light";
  button.setAttribute("aria-label", "switch between dark and light");
  button.addEventListener("click", function () { chosen = isDark() ? "light" : "dark"; apply(); });
  document.body.prepend(button);
  apply();
  // Colours of a figure that are those of the page.
  function paint(layout) {
    const ink = isDark() ? "#e4e9ee" : "#1d2733";
    const muted = isDark() ? "#a7b1bc" : "#55606e";
    const grid = isDark() ? "#39434e" : "#e1e6eb";
    layout.font = Object.assign({}, layout.font, { color: ink });
    const axes = Object.keys(layout).filter(function (k) { return /^[xy]axis/.test(k); }).map(function (k) { return layout[k]; });
    for (const key of Object.keys(layout)) {
      if (/^scene/.test(key)) axes.push(layout[key].xaxis, layout[key].yaxis, layout[key].zaxis);
    }
    for (const axis of axes) {
      if (!axis) continue;
      axis.gridcolor = grid;
      axis.tickfont = Object.assign({}, axis.tickfont, { color: muted });
      if (axis.title && axis.title.font) axis.title.font.color = muted;
    }
  }
  return { paint: paint, onChange: function (f) { listeners.push(f); }, isDark: isDark };
})();

// Unpacks plotly.js and the data of the page, then runs its script.
async function start(run) {
  const page = document.querySelector("main");
  function fail(text) {
    const p = document.createElement("p");
    p.className = "failure";
    p.textContent = text;
    page.prepend(p);
  }
  if (typeof DecompressionStream === "undefined") {
    fail("This browser cannot unpack the pictures of this page (it lacks DecompressionStream). A current Chrome, Edge, Firefox or Safari shows them.");
    return;
  }
  async function unpacked(element) {
    const bytes = Uint8Array.from(atob(element.textContent), function (c) { return c.charCodeAt(0); });
    const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
    return new Response(stream).text();
  }
  try {
    const data = {};
    for (const element of document.querySelectorAll("script.packed")) {
      data[element.id] = JSON.parse(await unpacked(element));
    }
    const plotly = document.createElement("script");
    plotly.textContent = await unpacked(document.getElementById("plotly-js"));
    document.head.append(plotly);
    run(data);
  } catch (error) {
    fail("The pictures of this page cannot be shown: " + error.message);
  }
}
