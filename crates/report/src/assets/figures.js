  const figures = new Map();

  function show(div) {
    if (!figures.has(div)) {
      figures.set(div, data[div.id + "-data"]);
    }
    const figure = figures.get(div);
    theme.paint(figure.layout);
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

  theme.onChange(function () {
    for (const [div, figure] of figures) {
      theme.paint(figure.layout);
      if (div.dataset.drawn !== "no") Plotly.react(div, figure.data, figure.layout, figure.config);
    }
  });
