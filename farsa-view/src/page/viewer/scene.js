// The scene of a life in WebGL 2: lit shapes with shadows, forces, rays, points, trails.

const SUN = unit([0.35, -0.45, 1.3]);
const TAN = 0.3;

const paint = (name) => rgb(colorOf(`--${name}`));
const rgb = (text) => [1, 3, 5].map((i) => parseInt(text.slice(i, i + 2), 16)/255);
// 1, 2 or 5 times a power of ten, not below x.
const rounded = (x) => {
	const power = 10**floor(Math.log10(x));
	return power*[1, 2, 5, 10].find((m) => m*power >= x*0.999);
};

// Matrices are column-major; axes are right, up, back.
const product = (a, b) => list(16, (i) => [0, 1, 2, 3].reduce((sum, k) => sum + a[4*k + i%4]*b[i - i%4 + k], 0));
const parallel = (x, y, far) => [1/x, 0, 0, 0, 0, 1/y, 0, 0, 0, 0, -2/far, 0, 0, 0, -1, 1];
const perspective = (x, y, near, far) => [1/x, 0, 0, 0, 0, 1/y, 0, 0, 0, 0, (near + far)/(near - far), -1, 0, 0, 2*near*far/(near - far), 0];
const viewFrom = (eye, axes) => [...[0, 1, 2].flatMap((i) => [...axes.map((a) => a[i]), 0]), ...axes.map((a) => -dot(a, eye)), 1];
const axesOf = (back) => {
	const right = unit(cross([0, 0, 1], back));
	return [right, cross(back, right), back];
};

const boundsOf = (balls) => [[min, -1], [max, 1]].map(([most, sign]) => [0, 1, 2].map((i) => most(...balls.map((b) => b.at[i] + sign*b.radius))));
const middleOf = ([low, high]) => mul(add(low, high), 0.5);

// What is wanted of a whole life, once.
function survey(life) {
	const {ticks, bodies, shapes} = life;
	const step = max(1, floor(ticks/60));
	const [balls, floors] = [[], []];
	for (const {body, role, kind, half, radius = hypot(...half || []), half_length: long = 0, position, rotation} of shapes) {
		if (body < 0 && ["ground", "area"].includes(role)) {
			const [x, y] = half || [radius, radius];
			if (kind !== "plane") for (const s of [-1, 1]) floors.push({at: add(position, [s*x, s*y, 0]), radius: 0});
			continue;
		}
		// A long shape by its two ends, so that the picture is no wider than it is.
		for (let t = 0; t < (body < 0 ? 1 : ticks); t += step) {
			const pose = body < 0 ? HOME : life.pose(t, body);
			for (const z of new Set([-long, long])) {
				const at = add(pose.position, turn(pose.rotation, add(position, turn(rotation, [0, 0, z]))));
				balls.push({at, radius, thing: role === "thing"});
			}
		}
	}
	if (!balls.length) balls.push({at: [0, 0, 0], radius: 1});
	// Of a robot of many bodies only the one that goes farthest leaves a trail.
	const moving = bodies.flatMap((name, body) => {
		const role = shapes.find((s) => s.body === body)?.role;
		const path = [];
		if (role) for (let t = 0; t < ticks; t += max(1, floor(ticks/1500))) path.push({t, at: life.pose(t, body).position});
		const way = max(...path.map(({at}) => hypot(...sub(at, path[0].at))));
		return way > 1e-3 ? [{name, path, way, thing: role === "thing"}] : [];
	});
	const robot = moving.filter((m) => !m.thing).sort((a, b) => b.way - a.way);
	const trails = [...moving.filter((m) => m.thing), ...robot.slice(0, robot.length > 6 ? 1 : 6)];
	const forces = list(ticks, (t) => life.contacts(t).map((c) => hypot(...c.force))).flat().sort((a, b) => a - b);
	const has = {forces: forces.length, points: life.points.length, rays: life.rayStarts.some((start) => life.words[start])};
	Object.assign(life, {balls, floors, trails, has, force: forces[floor(forces.length*0.95)] || 1});
}

// One camera for both views: lives are compared from the same place.
class Camera {
	axes(top = this.top) {
		const [level, {yaw, pitch}] = [cos(this.pitch), this];
		return top ? [[1, 0, 0], [0, 1, 0], [0, 0, 1]] : axesOf([cos(yaw)*level, sin(yaw)*level, sin(pitch)]);
	}

	// Frames what moves, with the things in front.
	frame(lives, aspect) {
		const all = lives.flatMap((life) => life.balls);
		const bounds = boundsOf(all);
		const middle = middleOf(bounds);
		this.force = max(...lives.map((life) => life.force));
		const things = all.filter((b) => b.thing);
		const [x, y] = sub(middleOf(boundsOf(things.length ? things : all)), middle);
		this.yaw = Math.atan2(y, x || 1e-9) - 0.75;
		this.pitch = 0.42;
		this.radius = max(1e-6, ...all.map((b) => hypot(...sub(b.at, middle)) + b.radius));
		const [right, up, back] = this.axes(false);
		this.target = middle;
		for (const axis of [right, up]) {
			const along = all.map(({at, radius}) => ({at: [dot(sub(at, middle), axis), 0, 0], radius}));
			this.target = add(this.target, mul(axis, middleOf(boundsOf(along))[0]));
		}
		this.distance = max(...all.map(({at, radius}) => {
			const p = sub(at, this.target);
			return dot(p, back) + max((abs(dot(p, right)) + radius)/aspect, abs(dot(p, up)) + radius)/(TAN*0.8);
		}));
		// Walls and areas are seen from above, unless they are far larger than what moves.
		const span = ([low, high]) => max(high[0] - low[0], high[1] - low[1]);
		const wide = boundsOf([...all, ...lives.flatMap((life) => life.floors)]);
		const flat = span(wide) < 4*span(bounds) ? wide : bounds;
		this.middle = middleOf(flat);
		this.half = 0.56*max(flat[1][1] - flat[0][1], (flat[1][0] - flat[0][0])/aspect, 1e-6);
	}

	lens(aspect) {
		const {top, half, radius, distance} = this;
		const axes = this.axes();
		const eye = top ? add(this.middle, [0, 0, 100*radius]) : add(this.target, mul(axes[2], distance));
		const lens = top ? parallel(half*aspect, half, 200*radius) : perspective(TAN*aspect, TAN, distance/50, distance + 60*radius);
		return {eye, lens: product(lens, viewFrom(eye, axes))};
	}

	turn(dx, dy) {
		this.yaw -= dx*0.008;
		this.pitch = min(1.55, max(-1.55, this.pitch + dy*0.008));
	}

	pan(dx, dy) {
		const [right, up] = this.axes();
		const what = this.top ? "middle" : "target";
		this[what] = add(this[what], mul(sub(mul(up, dy), mul(right, dx)), 2*(this.top ? this.half : TAN*this.distance)));
	}

	zoom(factor) {
		this[this.top ? "half" : "distance"] *= factor;
	}

	// Round numbers, for the legend.
	arrow() {
		return {long: rounded(this.radius*0.12), newtons: rounded(this.force*0.4)};
	}
}

// Vertices of position 3, normal 3, and 1 for the end of a capsule on which they are: -1, 1.
function meshes() {
	const vertex = ([r, z, nr, nz, end], j, n) => {
		const [c, s] = [cos(2*Math.PI*(j + 0.5)/n), sin(2*Math.PI*(j + 0.5)/n)];
		return [r*c, r*s, z, nr*c, nr*s, nz, end];
	};
	// Rows: radius, z, normal's radius, normal's z, end.
	const around = (rows, n = 32) => rows.slice(1).flatMap((row, i) => list(n, (j) => {
		const [a, b, c, d] = [vertex(rows[i], j, n), vertex(rows[i], j + 1, n), vertex(row, j, n), vertex(row, j + 1, n)];
		return [a, b, d, a, d, c].flat();
	}).flat());
	const arc = list(18, (k) => {
		const a = (k - (k < 9 ? 8 : 9))*Math.PI/16;
		return [cos(a), sin(a), cos(a), sin(a), k < 9 ? -1 : 1];
	});
	return {
		// Without normals: the shader finds those of flat faces.
		box: around([[0, -1], [Math.SQRT2, -1], [Math.SQRT2, 1], [0, 1]].map((row) => [...row, 0, 0, 0]), 4), capsule: around(arc), cone: around([[0, 0, 0, -1, 0], [1, 0, 0.9, 0.4, 0], [0, 1, 0.9, 0.4, 0]]),
		cylinder: [-1, 0, 1].flatMap((z) => around(z ? [[0, z, 0, z, 0], [1, z, 0, z, 0]] : [[1, -1, 1, 0, 0], [1, 1, 1, 0, 0]])),
	};
}

const SOLID = [`layout(location=0) in vec3 position; layout(location=1) in vec3 normal; layout(location=2) in float end;
uniform mat4 camera, light; uniform vec4 rotation; uniform vec3 origin, size; uniform float stretch;
out vec3 at, facing, lit;
vec3 turn(vec3 v) { return v + 2.*cross(rotation.xyz, cross(rotation.xyz, v) + rotation.w*v); }
void main() {
	at = turn(position*size + vec3(0, 0, end*stretch)) + origin;
	facing = turn(normal);
	lit = (light*vec4(at, 1)).xyz*.5 + .5;
	gl_Position = camera*vec4(at, 1);
}`, `precision highp sampler2DShadow;
in vec3 at, facing, lit;
uniform sampler2DShadow shadows; uniform vec4 color; uniform vec3 sun, eye, fog, middle; uniform float grid, reach, plain;
out vec4 pixel;
float lines(float step) {
	vec2 p = at.xy/step, d = max(fwidth(p), 1e-6), q = abs(fract(p - .5) - .5)/d;
	return (1. - min(min(q.x, q.y), 1.))*clamp(1.4 - 3.*max(d.x, d.y), 0., 1.);
}
void main() {
	vec3 n = normalize(length(facing) > .1 ? facing : cross(dFdx(at), dFdy(at))), to = normalize(eye - at);
	if (dot(n, to) < 0.) n = -n;
	float open = 1.;
	if (all(lessThan(abs(lit - .5), vec3(.5)))) {
		open = 0.;
		for (int i = 0; i < 9; i++) open += texture(shadows, lit + vec3(i%3 - 1, i/3 - 1, 0)*.0012)/9.;
	}
	float face = max(dot(n, sun), 0.)*mix(.25, 1., open);
	// A little light from the eye keeps the far side from the sun readable.
	vec3 c = color.rgb*mix(.38 + .1*n.z + .18*dot(n, to) + .36*face, 1., plain);
	if (grid == 0.) c += (1. - plain)*.12*face*pow(max(dot(n, normalize(sun + to)), 0.), 40.);
	else {
		if (n.z > .9) c = mix(c, vec3(step(c.r + c.g + c.b, 1.2)), .1*lines(grid) + .1*lines(grid*5.));
		// The ground fades out far from what moves.
		c = mix(c, fog, smoothstep(reach*.45, reach, length(at - middle)));
	}
	pixel = vec4(c, color.a);
}`];

// Throws where there is no WebGL 2.
function sceneOn(canvas, restored) {
	const gl = canvas.getContext("webgl2", {alpha: false});
	need(gl, "no context");
	let program, solids, map, shadow, matrix, camera, places;

	function build() {
		places = {};
		program = gl.createProgram();
		SOLID.forEach((source, i) => {
			const shader = gl.createShader(i ? gl.FRAGMENT_SHADER : gl.VERTEX_SHADER);
			gl.shaderSource(shader, `#version 300 es\nprecision highp float;\n${source}`);
			gl.compileShader(shader);
			gl.attachShader(program, shader);
		});
		gl.linkProgram(program);
		need(gl.getProgramParameter(program, gl.LINK_STATUS), gl.getProgramInfoLog(program));
		gl.useProgram(program);
		solids = Object.fromEntries(Object.entries(meshes()).map(([name, data]) => {
			const array = gl.createVertexArray();
			gl.bindVertexArray(array);
			gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer());
			gl.bufferData(gl.ARRAY_BUFFER, new Float32Array(data), gl.STATIC_DRAW);
			[3, 3, 1].forEach((size, i) => {
				gl.enableVertexAttribArray(i);
				gl.vertexAttribPointer(i, size, gl.FLOAT, false, 28, 12*i);
			});
			return [name, {array, count: data.length/7}];
		}));
		gl.bindTexture(gl.TEXTURE_2D, map = gl.createTexture());
		gl.texStorage2D(gl.TEXTURE_2D, 1, gl.DEPTH_COMPONENT24, 1024, 1024);
		gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.LINEAR);
		gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_COMPARE_MODE, gl.COMPARE_REF_TO_TEXTURE);
		gl.bindFramebuffer(gl.FRAMEBUFFER, shadow = gl.createFramebuffer());
		gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.DEPTH_ATTACHMENT, gl.TEXTURE_2D, map, 0);
		gl.drawBuffers([gl.NONE]);
		gl.enable(gl.DEPTH_TEST);
		gl.blendFunc(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA);
	}

	function set(values) {
		for (const [name, value] of Object.entries(values)) {
			const at = places[name] ??= gl.getUniformLocation(program, name);
			if (value.length === 16) gl.uniformMatrix4fv(at, false, value);
			else gl[`uniform${value.length || 1}fv`](at, value.length ? value : [value]);
		}
	}

	function mesh(kind, origin, rotation, size, color, stretch = 0) {
		set({origin, rotation, size, color, stretch});
		gl.bindVertexArray(solids[kind].array);
		gl.drawArrays(gl.TRIANGLES, 0, solids[kind].count);
	}

	const ball = (at, r, color) => mesh("capsule", at, HOME.rotation, [r, r, r], color);

	function shape({shape: {kind, radius: r, half, half_length: long}, origin, rotation, color}) {
		const wide = 60*camera.radius;
		const size = {box: half, plane: [wide, wide, 0], cylinder: [r, r, long]}[kind] || [r, r, r];
		mesh({sphere: "capsule", plane: "box"}[kind] || kind, origin, rotation, size, color, kind === "capsule" ? long : 0);
	}

	function line(a, b, thick, color, head = 0) {
		const long = hypot(...sub(b, a));
		const along = unit(sub(b, a));
		const rotation = along[2] < -0.9999 ? [1, 0, 0, 0] : unit([-along[1], along[0], 0, 1 + along[2]]);
		const shaft = max(0, long - head)/2;
		mesh("cylinder", add(a, mul(along, shaft)), rotation, [thick, thick, shaft], color);
		if (head) mesh("cone", add(a, mul(along, 2*shaft)), rotation, [2.4*thick, 2.4*thick, long - 2*shaft], color);
	}

	function draw(life, tick, from, visible) {
		const {width, height} = canvas;
		if (gl.isContextLost()) return;
		camera = from;
		const {eye, lens} = camera.lens(width/height);
		matrix = lens;
		const poses = life.bodies.map((_, b) => life.between(tick, b));
		const placed = life.shapes.map((shape) => {
			const {position, rotation} = poses[shape.body] || HOME;
			// Neighbours along a chain differ a little, so that joints are seen, and walls from the floor.
			const wall = shape.role === "ground" && shape.position[2] > 0;
			const color = shape.color ? rgb(shape.color) : mul(paint(shape.role), wall ? 0.7 : shape.role === "robot" && shape.body%2 ? 0.86 : 1);
			return {shape, wall, color: [...color, 1], origin: add(position, turn(rotation, shape.position)), rotation: join(rotation, shape.rotation)};
		});
		const bounds = boundsOf(life.balls);
		const middle = middleOf(bounds);
		const far = 0.58*hypot(...sub(...bounds));
		const light = product(parallel(far, far, 6*far), viewFrom(add(middle, mul(SUN, 3*far)), axesOf(SUN)));
		const seen = camera.top ? camera.half : camera.distance*TAN;
		set({camera: light, light, sun: SUN, eye, fog: paint("sky"), middle, reach: max(9*camera.radius, 3*seen), plain: 0, grid: 0});
		gl.disable(gl.BLEND);
		gl.depthMask(true);
		gl.depthFunc(gl.LESS);
		gl.bindTexture(gl.TEXTURE_2D, null);
		gl.bindFramebuffer(gl.FRAMEBUFFER, shadow);
		gl.viewport(0, 0, 1024, 1024);
		gl.clear(gl.DEPTH_BUFFER_BIT);
		gl.enable(gl.POLYGON_OFFSET_FILL);
		gl.polygonOffset(2, 8);
		for (const item of placed) if (["robot", "thing"].includes(item.shape.role)) shape(item);

		gl.bindFramebuffer(gl.FRAMEBUFFER, null);
		gl.bindTexture(gl.TEXTURE_2D, map);
		gl.viewport(0, 0, width, height);
		gl.clearColor(...paint("sky"), 1);
		gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
		const grid = rounded(camera.radius/8);
		for (const item of placed) {
			set({camera: lens, grid: item.shape.role === "ground" && !item.wall ? grid : 0});
			// An area lies in the floor and wins over it.
			gl.polygonOffset(...item.shape.role === "area" ? [-2, -8] : [0, 0]);
			shape(item);
		}
		gl.disable(gl.POLYGON_OFFSET_FILL);
		gl.enable(gl.BLEND);
		gl.depthMask(false);
		set({plain: 0.6, grid: 0});
		const {long, newtons} = camera.arrow();
		const [thin, thick] = [seen*0.005, camera.radius*0.0065];
		// What is behind a shape shows through it faintly: contacts always lie between two of them.
		for (const [order, alpha] of [[gl.GREATER, 0.3], [gl.LEQUAL, 1]]) {
			gl.depthFunc(order);
			const tint = (name, part = 1) => [...paint(name), alpha*part];
			if (visible.forces) {
				for (const {point, force} of life.contacts(tick)) {
					ball(point, 1.6*thick, tint("force"));
					const arrow = mul(force, long/newtons);
					line(point, add(point, mul(arrow, min(1, camera.radius/hypot(...arrow)))), thick, tint("force"), 6*thick);
				}
			}
			if (visible.points) life.points.forEach((_, p) => ball(life.point(tick, p), camera.radius*0.016, tint("point")));
			if (visible.rays) for (const {from, to, met} of life.rays(tick)) line(from, to, thin, met ? tint("a") : tint("ray", 0.5));
			// The way so far, and faintly the way to come.
			if (visible.trails) {
				for (const {path, thing} of life.trails) {
					path.reduce((last, {t, at}) => {
						if (hypot(...sub(at, last)) < camera.radius*0.01) return last;
						line(last, at, thin*1.4, tint(thing ? "thing" : "trail", t <= tick ? 1 : 0.3));
						return at;
					}, path[0].at);
				}
			}
		}
	}

	function project(p) {
		const [x, y, , w] = [0, 1, 2, 3].map((r) => dot([0, 4, 8].map((c) => matrix[c + r]), p) + matrix[12 + r]);
		return w > 0 ? [0.5 + x/w/2, 0.5 - y/w/2] : null;
	}

	build();
	canvas.addEventListener("webglcontextlost", (event) => event.preventDefault());
	canvas.addEventListener("webglcontextrestored", () => (build(), restored()));
	return {draw, project};
}
