"use strict";
// Bodies as they moved, over the timeline of what was found. Reads the JSON and the glTF of its page.

const data = JSON.parse(document.getElementById("data").textContent);
const bytes = (text) => Uint8Array.from(atob(text), (each) => each.charCodeAt(0)).buffer;
const floats = (text) => new Float32Array(bytes(text));
const times = floats(data.times);
const first = times[0], last = times[times.length - 1];
const element = (id) => document.getElementById(id);

const place = element("scene");
const renderer = new THREE.WebGLRenderer({ antialias: true, preserveDrawingBuffer: true });
place.append(renderer.domElement);
const scene = new THREE.Scene();
scene.background = new THREE.Color("#fbfbfb");
const camera = new THREE.PerspectiveCamera(40, 1, 0.01, 100);
camera.up.set(0, 0, 1);
const controls = new THREE.OrbitControls(camera, renderer.domElement);
scene.add(new THREE.HemisphereLight("#ffffff", "#888888", 2.2));
const sun = new THREE.DirectionalLight("#ffffff", 1.6);
sun.position.set(1, -2, 4);
scene.add(sun);

const bodies = new Map();
for (const body of data.bodies) {
  const group = new THREE.Group();
  const axes = new THREE.AxesHelper(0.08);
  axes.visible = false;
  const name = document.createElement("div");
  name.className = "name";
  name.textContent = body.label;
  if (!["body", "finger"].includes(body.kind)) place.append(name);
  group.add(axes);
  scene.add(group);
  bodies.set(body.name, {
    group, axes, name, kind: body.kind, colour: body.colour, faint: body.faint, surface: null, reach: 0,
    positions: floats(body.positions), orientations: floats(body.orientations),
  });
}
const looks = data.looks.map(([who, what, from, to]) => {
  const line = new THREE.Line(
    new THREE.BufferGeometry().setFromPoints([new THREE.Vector3(), new THREE.Vector3()]),
    new THREE.LineBasicMaterial({ color: "#8a6bc9" }));
  line.frustumCulled = false;
  scene.add(line);
  return { who, what, from, to, line };
});

let frame = 0, playing = false, started = 0, startedAt = 0;

function from(time) {
  let low = 0, high = times.length - 1;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (times[middle] < time) low = middle + 1; else high = middle;
  }
  return low;
}

function show(index) {
  frame = Math.min(Math.max(index, 0), times.length - 1);
  const time = times[frame];
  const touching = new Set();
  for (const [one, other, from, to] of data.contacts)
    if (from <= time && time <= to) touching.add(one).add(other);
  for (const [name, body] of bodies) {
    const [x, y, z] = body.positions.subarray(3 * frame, 3 * frame + 3);
    const [w, i, j, k] = body.orientations.subarray(4 * frame, 4 * frame + 4);
    body.group.visible = !Number.isNaN(x);
    if (!body.group.visible) continue;
    body.group.position.set(x, y, z);
    body.group.quaternion.set(i, j, k, w);
    const near = touching.has(name) && body.kind !== "fixed";
    if (body.surface) body.surface.material.emissive.set(near ? "#a03010" : "#000000");
  }
  for (const look of looks) {
    const [one, two] = [bodies.get(look.who), bodies.get(look.what)];
    look.line.visible = look.from <= time && time <= look.to && one && two;
    if (look.line.visible)
      look.line.geometry.setFromPoints([one.group.position, two.group.position]);
  }
  element("scrub").value = frame;
  element("clock").textContent = `${time.toFixed(2)} s`;
  for (const span of document.querySelectorAll(".span"))
    span.classList.toggle("now", span.dataset.start <= time && time <= span.dataset.end);
  const track = document.querySelector(".track");
  if (track) {
    const left = track.offsetLeft + (time - first) / (last - first || 1) * track.offsetWidth;
    element("cursor").style.left = `${left}px`;
  }
  draw();
}

function draw() {
  renderer.render(scene, camera);
  const named = element("names").checked;
  for (const body of bodies.values()) {
    const at = body.group.position.clone().project(camera);
    body.name.hidden = !named || !body.group.visible || at.z > 1 || Math.abs(at.x) > 1 || Math.abs(at.y) > 1;
    body.name.style.left = `${(at.x + 1) / 2 * place.clientWidth}px`;
    body.name.style.top = `${(1 - at.y) / 2 * place.clientHeight}px`;
  }
}

function resize() {
  renderer.setPixelRatio(window.devicePixelRatio);
  renderer.setSize(place.clientWidth, place.clientHeight);
  camera.aspect = place.clientWidth / Math.max(place.clientHeight, 1);
  camera.updateProjectionMatrix();
  show(frame);
}

function look() {
  const box = new THREE.Box3();
  for (const body of bodies.values())
    for (let at = 0; at < body.positions.length; at += 3)
      if (body.kind !== "fixed" && !Number.isNaN(body.positions[at])) {
        const middle = new THREE.Vector3(...body.positions.subarray(at, at + 3));
        const reach = new THREE.Vector3().setScalar(body.reach);
        box.expandByPoint(middle.clone().add(reach)).expandByPoint(middle.sub(reach));
      }
  if (box.isEmpty()) box.expandByPoint(new THREE.Vector3());
  const middle = box.getCenter(new THREE.Vector3());
  const far = Math.max(box.getSize(new THREE.Vector3()).length(), 0.4) * 1.15;
  camera.position.copy(middle).add(new THREE.Vector3(0.9, -1.1, 0.7).normalize().multiplyScalar(far * 1.2));
  controls.target.copy(middle);
  controls.update();
}

function timeline() {
  const holder = element("timeline");
  for (const row of data.rows) {
    const line = document.createElement("div");
    const label = document.createElement("div");
    line.className = row.heading ? "row heading" : "row";
    label.className = "label";
    label.textContent = label.title = row.heading || row.label;
    line.append(label);
    if (row.spans) {
      const track = document.createElement("div");
      track.className = "track";
      for (const span of row.spans) track.append(button(span));
      line.append(track);
    }
    holder.append(line);
  }
  const cursor = document.createElement("div");
  cursor.id = "cursor";
  holder.append(cursor);
}

function button(span) {
  const made = document.createElement("button");
  const share = (time) => `${100 * (time - first) / (last - first || 1)}%`;
  made.className = "span";
  made.textContent = span.label;
  made.title = `${span.label} ${span.start.toFixed(2)} to ${span.end.toFixed(2)} s`;
  made.dataset.start = span.start;
  made.dataset.end = span.end;
  made.style.left = share(span.start);
  made.style.width = share(first + span.end - span.start);
  made.style.background = span.colour;
  made.addEventListener("click", () => { pause(); show(from(span.start)); });
  return made;
}

function pause() {
  playing = false;
  element("play").textContent = "Play";
}

function play() {
  if (frame === times.length - 1) show(0);
  playing = true;
  started = performance.now();
  startedAt = times[frame];
  element("play").textContent = "Pause";
  step();
}

function step() {
  if (!playing) return;
  const time = startedAt + (performance.now() - started) / 1000 * Number(element("speed").value);
  show(from(time));
  if (time >= last) pause(); else setTimeout(step, 1000 / 60);
}

element("play").addEventListener("click", () => (playing ? pause() : play()));
element("speed").addEventListener("change", () => { if (playing) { pause(); play(); } });
element("scrub").max = times.length - 1;
element("scrub").addEventListener("input", (event) => { pause(); show(Number(event.target.value)); });
element("axes").addEventListener("change", (event) => {
  for (const body of bodies.values()) body.axes.visible = event.target.checked;
  draw();
});
element("names").addEventListener("change", draw);
controls.addEventListener("change", draw);
window.addEventListener("resize", resize);
window.addEventListener("keydown", (event) => {
  if (event.target.tagName === "SELECT") return;
  if (event.key === " ") { event.preventDefault(); playing ? pause() : play(); }
  if (event.key === "ArrowRight") { pause(); show(frame + 1); }
  if (event.key === "ArrowLeft") { pause(); show(frame - 1); }
});

timeline();
// Of very many bodies names would cover the picture.
element("names").checked = data.bodies.length <= 15;
new THREE.GLTFLoader().parse(bytes(element("surfaces").textContent), "", (loaded) => {
  for (const [name, body] of bodies) {
    const found = loaded.scene.getObjectByName(name);
    const material = new THREE.MeshStandardMaterial({
      color: body.colour, side: THREE.DoubleSide, flatShading: true, roughness: 0.8,
      transparent: body.faint || body.kind === "fixed",
      opacity: body.faint ? 0.35 : body.kind === "fixed" ? 0.6 : 1,
    });
    body.surface = found
      ? new THREE.Mesh((found.isMesh ? found : found.children[0]).geometry, material)
      : new THREE.Mesh(new THREE.SphereGeometry(0.015, 16, 12), material);
    body.surface.geometry.computeBoundingSphere();
    body.reach = body.surface.geometry.boundingSphere.radius;
    body.group.add(body.surface);
  }
  look();
  resize();
  document.body.dataset.ready = "yes";
});
