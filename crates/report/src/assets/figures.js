(function () {
  "use strict";
  const figures = new Map();

  function show(div) {
    if (!figures.has(div)) {
      figures.set(div, JSON.parse(document.getElementById(div.id + "-data").textContent));
    }
    const figure = figures.get(div);
    Plotly.newPlot(div, figure.data, figure.layout, figure.config);
  }

  // Browsers grant about sixteen graphics contexts a page: a 3-D figure gives its own back
  // when it is far from view. Its layout object, and with it the camera, stays.
  const watcher = new IntersectionObserver(function (entries) {
    for (const entry of entries) {
      const div = entry.target;
      const drawn = div.dataset.drawn === "yes";
      if (entry.isIntersecting && !drawn) {
        show(div);
        div.dataset.drawn = "yes";
      } else if (!entry.isIntersecting && drawn) {
        Plotly.purge(div);
        div.dataset.drawn = "no";
      }
    }
  }, { rootMargin: "400px" });

  for (const div of document.querySelectorAll(".plot")) {
    if (div.classList.contains("three-d")) watcher.observe(div);
    else show(div);
  }
})();
