  data = data["grasp-data"];
  const view = document.getElementById("view");
  const selector = document.getElementById("selector");
  const rows = document.querySelectorAll("#grasps tbody tr");
  const count = data.grasps.length;
  let current = 0;
  let cameraIsOurs = true;
  let drawn = false;

  // A switch that the page does not have is off.
  function isOn(name) {
    const box = document.getElementById("show-" + name);
    return box !== null && box.checked;
  }

  function shownTraces() {
    const traces = data.plot.data.concat(count > 0 ? data.grasps[current] : []);
    for (const trace of traces) {
      if (trace.meta === "surface") trace.opacity = isOn("glass") ? 0.4 : 1;
      if (trace.meta === "hand") trace.opacity = isOn("handglass") ? 0.45 : 1;
      if (trace.meta === "surface") continue;
      if (trace.meta !== "grasp") trace.visible = isOn(trace.meta);
    }
    return traces;
  }

  function draw() {
    // Until the reader turns the view, every grasp is shown from its own side; handing back the
    // same layout then keeps the camera where the reader left it.
    if (cameraIsOurs && count > 0) Object.assign(data.plot.layout.scene.camera, data.cameras[current]);
    theme.paint(data.plot.layout);
    Plotly.react(view, shownTraces(), data.plot.layout, data.plot.config);
  }

  function select(index) {
    current = (index + count) % count;
    if (drawn) history.replaceState(null, "", "#" + (current + 1));
    selector.value = String(current);
    rows.forEach(function (row, k) { row.classList.toggle("current", k === current); });
    document.querySelectorAll(".details").forEach(function (block, k) { block.hidden = k !== current; });
    draw();
  }

  document.querySelectorAll(".controls input").forEach(function (box) {
    box.addEventListener("change", draw);
  });
  if (count === 0) {
    draw();
    return;
  }
  selector.addEventListener("change", function () { select(Number(selector.value)); });
  document.getElementById("previous").addEventListener("click", function () { select(current - 1); });
  document.getElementById("next").addEventListener("click", function () { select(current + 1); });
  rows.forEach(function (row) {
    row.addEventListener("click", function () { select(Number(row.dataset.index)); });
  });
  document.addEventListener("keydown", function (event) {
    if (event.target.matches("select, input")) return;
    if (event.key === "ArrowLeft" || event.key === "ArrowUp") select(current - 1);
    else if (event.key === "ArrowRight" || event.key === "ArrowDown") select(current + 1);
    else return;
    event.preventDefault();
  });
  document.querySelectorAll("button.copy").forEach(function (button) {
    button.addEventListener("click", function () {
      const done = function () { button.textContent = "copied"; };
      const box = document.createElement("textarea");
      box.value = button.dataset.text;
      if (navigator.clipboard && window.isSecureContext) {
        navigator.clipboard.writeText(box.value).then(done);
        return;
      }
      document.body.append(box);
      box.select();
      if (document.execCommand("copy")) done();
      box.remove();
    });
  });
  theme.onChange(draw);
  window.addEventListener("hashchange", function () {
    const rank = parseInt(location.hash.slice(1), 10);
    if (rank >= 1 && rank <= count) select(rank - 1);
  });
  const rank = parseInt(location.hash.slice(1), 10);
  select(rank >= 1 && rank <= count ? rank - 1 : 0);
  drawn = true;
  // There are events of the view only once it has been drawn.
  view.on("plotly_relayout", function (change) {
    if (change["scene.camera"]) cameraIsOurs = false;
  });
