// SPDX-License-Identifier: GPL-3.0-or-later
// Surfaces that turn: each figure of the class "turning" whose picture is turning_NAME.png gets the model models/NAME.glb
// in its place. The picture stays where there is no WebGL, or no host to fetch the model from (a page opened from disk).
"use strict";

(() => {
  const STATIC = new URL("./", document.currentScript.src);
  const FIRST = "Thin plate";
  const FIELD = 14; // degrees, from top to bottom
  // where the camera is at first: degrees about the vertical, degrees above the horizon, distance (1: all fits in, however
  // it turns); and how many stripes: flat shapes need more
  const VIEWS = {
    hull: [-40, 18, 0.68, 14],
    fender: [-28, 16, 0.7, 7],
    branching: [25, 18, 0.8, 6],
  };

  const vertexShader = `
    varying vec3 vNormal, vView;
    void main() {
      vec4 seen = modelViewMatrix * vec4(position, 1.0);
      vNormal = normalMatrix * normal;
      vView = -seen.xyz;
      gl_Position = projectionMatrix * seen;
    }`;

  // Level lamps all around, as in a car maker's light tunnel: stripes in what the surface mirrors.
  const fragmentShader = `
    uniform float zebra, stripes;
    varying vec3 vNormal, vView;
    void main() {
      vec3 n = normalize(vNormal) * (gl_FrontFacing ? 1.0 : -1.0), v = normalize(vView);
      float wave = sin(stripes * 3.14159265 * reflect(-v, n).y);
      float soft = fwidth(wave);
      vec3 stripe = mix(vec3(0.20, 0.22, 0.26), vec3(0.96), smoothstep(-soft, soft, wave)); // dark, but no page is so dark
      vec3 clay = vec3(0.80, 0.70, 0.60) * (0.30 + 0.70 * max(dot(n, normalize(vec3(-0.4, 0.8, 0.6))), 0.0));
      float facing = 0.75 + 0.25 * max(dot(n, v), 0.0);
      gl_FragColor = vec4(mix(clay, stripe * facing, zebra), 1.0);
    }`;

  function button(text, group, choose) {
    const made = document.createElement("button");
    made.type = "button";
    made.textContent = text;
    made.addEventListener("click", () => {
      choose();
      for (const other of group.children) other.setAttribute("aria-pressed", String(other === made));
    });
    group.append(made);
    return made;
  }

  function group(parent, label) {
    const made = document.createElement("span");
    made.setAttribute("role", "group");
    made.setAttribute("aria-label", label);
    parent.append(made);
    return made;
  }

  function start(figure, image, name, model) {
    const renderer = new THREE.WebGLRenderer({ alpha: true, antialias: true });
    renderer.setPixelRatio(Math.min(window.devicePixelRatio, 2));
    const canvas = renderer.domElement;
    canvas.setAttribute("role", "img");
    canvas.setAttribute("aria-label", image.alt);

    const [turn, rise, distance, stripes] = VIEWS[name];
    const look = { zebra: { value: 1 }, stripes: { value: stripes } };
    const skin = new THREE.ShaderMaterial({
      uniforms: look, vertexShader, fragmentShader, side: THREE.DoubleSide, extensions: { derivatives: true },
    });
    const wire = new THREE.LineBasicMaterial({ color: 0xd2541b, depthTest: false, transparent: true, opacity: 0.8 });
    const surfaces = new Map();
    let lines = null;
    for (const node of model.children) {
      const isControl = node.name === "Control_mesh";
      node.traverse((part) => { if (part.isLine || part.isMesh) part.material = isControl ? wire : skin; });
      if (isControl) lines = node; else surfaces.set(node.name.replace(/_/g, " "), node);
    }

    const scene = new THREE.Scene();
    scene.add(model);
    const ball = new THREE.Box3().setFromObject(model).getBoundingSphere(new THREE.Sphere());
    const camera = new THREE.PerspectiveCamera(FIELD, 1, ball.radius / 10, ball.radius * 20);
    const degree = Math.PI / 180;
    const away = new THREE.Vector3().setFromSphericalCoords(1, (90 - rise) * degree, turn * degree);
    camera.position.copy(ball.center).addScaledVector(away, distance * ball.radius / Math.sin(FIELD / 2 * degree));

    const controls = new THREE.OrbitControls(camera, canvas);
    controls.target.copy(ball.center);
    controls.enableZoom = controls.enablePan = controls.enableKeys = false; // the page scrolls
    controls.autoRotate = !window.matchMedia("(prefers-reduced-motion: reduce)").matches;
    controls.autoRotateSpeed = 1.5;
    canvas.style.touchAction = "pan-y";
    canvas.addEventListener("pointerdown", () => { controls.autoRotate = false; });

    image.replaceWith(canvas);
    const bar = document.createElement("div");
    bar.className = "turning-choices";
    canvas.after(bar);
    const ways = group(bar, "Surface"), looks = group(bar, "Look");
    for (const way of surfaces.keys()) {
      const made = button(way, ways, () => surfaces.forEach((node, key) => { node.visible = key === way; }));
      if (way === FIRST) made.click();
    }
    button("Zebra", looks, () => { look.zebra.value = 1; }).click();
    button("Clay", looks, () => { look.zebra.value = 0; });
    if (lines) {
      lines.visible = false;
      const toggle = document.createElement("button");
      toggle.type = "button";
      toggle.textContent = "Control mesh";
      toggle.setAttribute("aria-pressed", "false");
      toggle.addEventListener("click", () => {
        lines.visible = !lines.visible;
        toggle.setAttribute("aria-pressed", String(lines.visible));
      });
      bar.append(toggle);
    }

    function draw() {
      const width = canvas.clientWidth, height = canvas.clientHeight;
      renderer.setSize(width, height, false);
      camera.aspect = width / height;
      camera.updateProjectionMatrix();
      controls.update();
      renderer.render(scene, camera);
    }
    // only what is seen is drawn
    new IntersectionObserver(([entry]) => renderer.setAnimationLoop(entry.isIntersecting ? draw : null)).observe(canvas);
    draw();
    figure.dataset.turning = "yes";
  }

  for (const figure of document.querySelectorAll("figure.turning")) {
    const image = figure.querySelector("img");
    const name = image.src.replace(/^.*\/turning_|\.png$/g, "");
    new THREE.GLTFLoader().load(
      new URL(`models/${name}.glb`, STATIC).href,
      (loaded) => {
        try {
          start(figure, image, name, loaded.scene);
        } catch (error) {
          console.warn(`${name} stays a picture: ${error}`);
        }
      },
      undefined,
      () => console.warn(`${name} stays a picture: its model cannot be fetched`),
    );
  }
})();
