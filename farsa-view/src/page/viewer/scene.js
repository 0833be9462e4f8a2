// The scene of a trial in WebGL 2: lit shapes with shadows, forces, rays, points, trails.

const SUN = unit([0.35, -0.45, 1.3]);

const paint = (name) => rgb(colorOf(`--${name}`));
const rgb = (text) => [1, 3, 5].map((i) => parseInt(text.slice(i, i + 2), 16)/255);
// Vertices of position 3, normal 3, and 1 for the end of a capsule on which they are: -1, 1.
// Meshes with fewer corners around, `n`, are used for small shapes.
function meshes(n) {
	const vertex = ([r, z, nr, nz, end], j, n) => {
		const [c, s] = [cos(2*PI*(j + 0.5)/n), sin(2*PI*(j + 0.5)/n)];
		return [r*c, r*s, z, nr*c, nr*s, nz, end];
	};
	// Rows: radius, z, normal's radius, normal's z, end.
	const around = (rows, m = n) => rows.slice(1).flatMap((row, i) => list(m, (j) => {
		const [a, b, c, d] = [vertex(rows[i], j, m), vertex(rows[i], j + 1, m), vertex(row, j, m), vertex(row, j + 1, m)];
		return [a, b, d, a, d, c].flat();
	}).flat());
	const quarter = n/4;
	const arc = list(2*quarter + 2, (k) => {
		const a = (k - (k <= quarter ? quarter : quarter + 1))*PI/2/quarter;
		return [cos(a), sin(a), cos(a), sin(a), k <= quarter ? -1 : 1];
	});
	return {
		// Without normals. The shader computes those of flat faces.
		box: around([[0, -1], [Math.SQRT2, -1], [Math.SQRT2, 1], [0, 1]].map((row) => [...row, 0, 0, 0]), 4), capsule: around(arc), cone: around([[0, 0, 0, -1, 0], [1, 0, 0.9, 0.4, 0], [0, 1, 0.9, 0.4, 0]]),
		cylinder: [-1, 0, 1].flatMap((z) => around(z ? [[0, z, 0, z, 0], [1, z, 0, z, 0]] : [[1, -1, 1, 0, 0], [1, 1, 1, 0, 0]])),
	};
}

const SOLID = [`layout(location=0) in vec3 position; layout(location=1) in vec3 normal; layout(location=2) in float end;
uniform mat4 camera, light; uniform vec4 rotation; uniform vec3 origin, size, eye; uniform float stretch, ribbon;
out vec3 at, facing, lit;
vec3 turn(vec3 v) { return v + 2.*cross(rotation.xyz, cross(rotation.xyz, v) + rotation.w*v); }
void main() {
	at = turn(position*size + vec3(0, 0, end*stretch)) + origin;
	facing = turn(normal);
	if (ribbon > 0.) {
		// A trail looks like a tube of that radius. Its normal is the direction along it, its end the side.
		vec3 across = cross(normal, eye - position);
		across /= max(length(across), 1e-9);
		vec3 front = cross(across, normal)/max(length(normal), 1e-9);
		at = position + ribbon*(front + end*length(normal)*across);
		facing = front + 2.*end*across;
	}
	lit = (light*vec4(at, 1)).xyz*.5 + .5;
	gl_Position = camera*vec4(at, 1);
}`, `precision highp sampler2DShadow;
in vec3 at, facing, lit;
uniform sampler2DShadow shadows; uniform highp sampler2D depths; uniform vec4 color; uniform vec3 sun, eye, fog, middle; uniform float grid, reach, plain;
out vec4 pixel;
float lines(float step) {
	vec2 p = at.xy/step, d = max(fwidth(p), 1e-6), q = abs(fract(p - .5) - .5)/d;
	return (1. - min(min(q.x, q.y), 1.))*clamp(1.4 - 3.*max(d.x, d.y), 0., 1.);
}
// Evenly spread places of a disk.
vec2 spread(int i, float count) { float r = sqrt((float(i) + .5)/count), a = float(i)*2.39996; return r*vec2(cos(a), sin(a)); }
// The share of the sun that is seen. Its half-shadow is as wide as what hides it is far.
float seen() {
	if (any(greaterThan(abs(lit - .5), vec3(.5)))) return 1.;
	float sum = 0., count = 0.;
	for (int i = 0; i < 12; i++) {
		float d = texture(depths, lit.xy + .02*spread(i, 12.)).r;
		if (d < lit.z - .001) { sum += d; count++; }
	}
	// Far from the edge of a shadow.
	if (count == 0.) return texture(shadows, lit);
	if (count == 12.) return 0.;
	float wide = clamp((lit.z - sum/count)*.35, .0012, .02), open = 0.;
	for (int i = 0; i < 24; i++) open += texture(shadows, lit + vec3(wide*spread(i, 24.), 0));
	return open/24.;
}
void main() {
	vec3 n = normalize(length(facing) > .1 ? facing : cross(dFdx(at), dFdy(at))), to = normalize(eye - at);
	if (dot(n, to) < 0.) n = -n;
	float face = max(dot(n, sun), 0.);
	if (face > 0.) face *= mix(.25, 1., seen());
	// A little light from the eye keeps the side away from the sun readable.
	vec3 c = color.rgb*mix(.38 + .1*n.z + .18*dot(n, to) + .36*face, 1., plain);
	if (grid == 0.) c += (1. - plain)*.12*face*pow(max(dot(n, normalize(sun + to)), 0.), 40.);
	else {
		if (n.z > .9) c = mix(c, vec3(step(c.r + c.g + c.b, 1.2)), .1*lines(grid) + .1*lines(grid*5.));
		// The ground fades out far from what moves.
		c = mix(c, fog, smoothstep(reach*.45, reach, length(at - middle)));
	}
	pixel = vec4(c, color.a);
}`];

// Shaders, meshes and the shadow map, created once per WebGL context.
function programOf(gl) {
	const program = gl.createProgram();
	SOLID.forEach((source, i) => {
		const shader = gl.createShader(i ? gl.FRAGMENT_SHADER : gl.VERTEX_SHADER);
		gl.shaderSource(shader, `#version 300 es\nprecision highp float;\n${source}`);
		gl.compileShader(shader);
		gl.attachShader(program, shader);
	});
	gl.linkProgram(program);
	need(gl.getProgramParameter(program, gl.LINK_STATUS), gl.getProgramInfoLog(program));
	return program;
}

function solidOf(gl, data) {
	const array = gl.createVertexArray();
	gl.bindVertexArray(array);
	gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer());
	gl.bufferData(gl.ARRAY_BUFFER, new Float32Array(data), gl.STATIC_DRAW);
	[3, 3, 1].forEach((size, i) => {
		gl.enableVertexAttribArray(i);
		gl.vertexAttribPointer(i, size, gl.FLOAT, false, 28, 12*i);
	});
	return {array, count: data.length/7};
}

// The vertices of a mesh. Faces at angles below 45 degrees have common normals.
function facetsOf({solid: {at, corners}, half}) {
	const around = [];
	const faces = corners.map((_, k) => {
		const [a, b, c] = corners.slice(k - k%3, k - k%3 + 3).map((i) => half.map((h, axis) => h*at[3*i + axis]));
		const normal = unit(cross(sub(b, a), sub(c, a)));
		(around[corners[k]] ??= []).push(normal);
		return normal;
	});
	return corners.flatMap((i, k) => [...half.map((_, axis) => at[3*i + axis]/32767), ...unit(around[i].filter((n) => dot(n, faces[k]) > 0.7).reduce(add, [0, 0, 0])), 0]);
}

function shadowsOf(gl) {
	const [map, frame] = [gl.createTexture(), gl.createFramebuffer()];
	gl.bindTexture(gl.TEXTURE_2D, map);
	gl.texStorage2D(gl.TEXTURE_2D, 1, gl.DEPTH_COMPONENT24, 1024, 1024);
	// The map is compared in the first unit and read in the second.
	const samplers = [[gl.LINEAR, gl.COMPARE_REF_TO_TEXTURE], [gl.NEAREST, gl.NONE]].map(([filter, compare]) => {
		const sampler = gl.createSampler();
		for (const end of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) gl.samplerParameteri(sampler, end, filter);
		for (const side of [gl.TEXTURE_WRAP_S, gl.TEXTURE_WRAP_T]) gl.samplerParameteri(sampler, side, gl.CLAMP_TO_EDGE);
		gl.samplerParameteri(sampler, gl.TEXTURE_COMPARE_MODE, compare);
		return sampler;
	});
	samplers.forEach((sampler, i) => gl.bindSampler(i, sampler));
	gl.bindFramebuffer(gl.FRAMEBUFFER, frame);
	gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.DEPTH_ATTACHMENT, gl.TEXTURE_2D, map, 0);
	gl.drawBuffers([gl.NONE]);
	return {map, frame};
}

// A path without pieces that are invisible in a scene of this radius.
function thinned(path, radius) {
	const kept = [path[0]];
	for (const p of path) if (hypot(...sub(p.at, kept.at(-1).at)) >= radius*0.01) kept.push(p);
	return kept;
}

// The opacity of a tube, both sides of which are visible.
const twice = (alpha) => alpha*(2 - alpha);

// A ribbon along a path, drawn as a strip, with the number of its vertices up to each time.
function ribbonOf(gl, path) {
	const data = [];
	const way = (i) => unit(sub((path[i + 1] || path[i]).at, (path[i] || path[i + 1]).at));
	const counts = path.map(({t, at}, i) => {
		const [before, after] = [way(max(0, i - 1)), way(min(i, path.length - 2))];
		const open = dot(before, after);
		// A bend is mitered. Where the path turns back, a second pair begins.
		const ways = open > 0 ? [mul(add(before, after), 1/(1 + open))] : [before, after];
		for (const along of ways) for (const side of [-1, 1]) data.push(...at, ...along, side);
		return {t, count: data.length/7};
	});
	return {...solidOf(gl, data), counts};
}

// The appearance of each trail at a tick. Each of several robots has its color, and the followed one is highlighted.
function trailsAt({trails}, tick, {followed}) {
	const many = trails.filter((trail) => !trail.thing)[1];
	const chosen = trails.some((trail) => trail.body === followed);
	return trails.map(({path, thing, body, top, tint}) => ({
		path,
		color: tint ? rgb(tint) : paint(thing ? "thing" : "trail"),
		part: chosen && body !== followed ? 0.25 : 1,
		// The mark of the robot.
		end: many && !thing && add(path.findLast(({t}) => t <= tick).at, [0, 0, top]),
	}));
}

// The visible shapes of a trial at a tick and the spots on the ground, each with its place and color.
function placedAt(trial, tick) {
	const poses = trial.bodies.map((_, b) => (trial.held?.body === b ? trial.held : trial.between(tick, b)));
	const shapes = trial.shapes.filter(({shown}) => {
		const value = shown && trial.channels[shown[0]].values[floor(tick)];
		return !shown || value >= shown[1] && value <= shown[2];
	}).map((shape) => {
		const {position, rotation} = poses[shape.body] || HOME;
		// Neighbors along a chain differ a little, so that joints are visible, as do walls and the floor.
		const wall = shape.role === "ground" && shape.position[2] > 0;
		const color = shape.color ? rgb(shape.color) : mul(paint(shape.role), wall ? 0.7 : shape.role === "robot" && shape.body%2 ? 0.86 : 1);
		return {shape, wall, color: [...color, 1], origin: add(position, turn(rotation, shape.position)), rotation: join(rotation, shape.rotation)};
	});
	return shapes.concat(trial.spots.flatMap(({shape, origin, changes}) => {
		const color = changes.findLast(([t]) => t <= tick)?.[1];
		return color ? [{shape, origin, color: [...color, 1], rotation: HOME.rotation}] : [];
	}));
}

const casts = ({shape: {role}}) => role === "robot" || role === "thing";

// The distance along a ray to a placed shape, or Infinity.
function metAt({shape: {kind, half, radius: r, half_length: long = 0}, origin, rotation}, from, along) {
	const back = [...mul(rotation, -1), rotation[3]];
	const [o, d] = [turn(back, sub(from, origin)), turn(back, along)];
	if (kind === "plane") return d[2] < 0 ? -o[2]/d[2] : Infinity;
	const slab = (h, i) => [(-h - o[i])/d[i], (h - o[i])/d[i]].sort((a, b) => a - b);
	// The distances within a ball, or without z in an endless cylinder, NaN for a miss.
	const round = (o, d) => {
		const [a, b] = [max(dot(d, d), 1e-12), dot(o, d)];
		const s = sqrt(b*b - a*(dot(o, o) - r*r));
		return [(-b - s)/a, (s - b)/a];
	};
	const both = (...spans) => {
		const [near, far] = [max(...spans.map((span) => span[0])), min(...spans.map((span) => span[1]))];
		return near <= far ? near : Infinity;
	};
	if (half) return both(...half.map(slab));
	const side = both(round([o[0], o[1], 0], [d[0], d[1], 0]), slab(long, 2));
	return kind === "cylinder" ? side : min(side, ...[long, -long].map((z) => both(round(sub(o, [0, 0, z]), d))));
}

// The first point of a ray on a shape, or null.
function metBy(placed, from, along) {
	const far = min(...placed.map((item) => metAt(item, from, along)).filter((t) => t > 0));
	return far < Infinity ? add(from, mul(along, far)) : null;
}

class Scene {
	// Throws Unsupported in a browser without WebGL 2.
	constructor(canvas, restored) {
		this.canvas = canvas;
		this.gl = canvas.getContext("webgl2", {alpha: false});
		if (!this.gl) throw new Unsupported("it needs a browser with WebGL 2");
		this.build();
		canvas.addEventListener("webglcontextlost", (event) => event.preventDefault());
		canvas.addEventListener("webglcontextrestored", () => (this.build(), restored()));
	}

	build() {
		const {gl} = this;
		const program = programOf(gl);
		gl.useProgram(program);
		const names = list(gl.getProgramParameter(program, gl.ACTIVE_UNIFORMS), (i) => gl.getActiveUniform(program, i).name);
		this.places = fromEntries(names.map((name) => [name, gl.getUniformLocation(program, name)]));
		this.solids = [16, 32, 96].map((n) => fromEntries(entries(meshes(n)).map(([name, data]) => [name, solidOf(gl, data)])));
		this.made = new WeakMap();
		this.shadows = shadowsOf(gl);
		gl.uniform1i(this.places.depths, 1);
		gl.enable(gl.DEPTH_TEST);
		gl.blendFunc(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA);
	}

	set(values) {
		const {gl, places} = this;
		for (const [name, value] of entries(values)) {
			const at = places[name];
			if (value.length === 16) gl.uniformMatrix4fv(at, false, value);
			else gl[`uniform${value.length || 1}fv`](at, value.length ? value : [value]);
		}
	}

	mesh(kind, origin, rotation, size, color, stretch = 0) {
		const {gl} = this;
		const {array, count} = kind.solid ? this.facets(kind) : this.solids[(size[0] > this.coarse) + (size[0] > 4*this.coarse)][kind];
		this.set({origin, rotation, size, color, stretch});
		gl.bindVertexArray(array);
		gl.drawArrays(gl.TRIANGLES, 0, count);
	}

	facets(shape) {
		const {gl, made} = this;
		if (!made.has(shape)) made.set(shape, solidOf(gl, facetsOf(shape)));
		return made.get(shape);
	}

	ball(at, r, color) {
		this.mesh("capsule", at, HOME.rotation, [r, r, r], color);
	}

	shape({shape, origin, rotation, color}) {
		const {kind, radius: r, half, half_length: long} = shape;
		const wide = 60*this.camera.radius;
		const size = {plane: [wide, wide, 0], cylinder: [r, r, long]}[kind] || half || [r, r, r];
		this.mesh({sphere: "capsule", plane: "box", mesh: shape}[kind] || kind, origin, rotation, size, color, kind === "capsule" ? long : 0);
	}

	line(a, b, thick, color, head = 0) {
		const long = hypot(...sub(b, a));
		const along = unit(sub(b, a));
		const rotation = along[2] < -0.9999 ? [1, 0, 0, 0] : unit([-along[1], along[0], 0, 1 + along[2]]);
		const shaft = max(0, long - head)/2;
		this.mesh("cylinder", add(a, mul(along, shaft)), rotation, [thick, thick, shaft], color);
		if (head) this.mesh("cone", add(a, mul(along, 2*shaft)), rotation, [2.4*thick, 2.4*thick, long - 2*shaft], color);
	}

	draw(trial, tick, camera, visible) {
		if (this.gl.isContextLost()) return;
		this.look(trial, tick, camera);
		const {eye, middle, reach, placed} = this;
		const far = 0.58*hypot(...sub(...trial.bounds));
		const light = product(parallel(far, far, 6*far), viewFrom(add(middle, mul(SUN, 3*far)), axesOf(SUN)));
		this.set({camera: light, light, sun: SUN, eye, fog: paint("sky"), middle: camera.carried ?? middle, reach, plain: 0, grid: 0});
		this.drawShadows(placed);
		this.drawShapes(placed);
		this.drawMarks(trial, tick, visible);
	}

	// Sets the view and the visible shapes. The ground fades out at a reach.
	look(trial, tick, camera) {
		const {top, half, distance, radius} = camera;
		const {eye, lens} = camera.lens(this.canvas.width/this.canvas.height);
		// Half the height of the view [m].
		const seen = top ? half : distance*TAN;
		const middle = middleOf(trial.bounds);
		// Up to a radius of 20 pixels the error of a coarse mesh is below half a pixel, and so is that of a finer one up to 80.
		this.coarse = 40*seen/this.canvas.height;
		assign(this, {camera, eye, matrix: lens, middle, reach: max(9*radius, 3*seen), thin: seen*0.005, placed: placedAt(trial, tick)});
	}

	bindMap(map) {
		const {gl} = this;
		for (const unit of [1, 0]) {
			gl.activeTexture(gl.TEXTURE0 + unit);
			gl.bindTexture(gl.TEXTURE_2D, map);
		}
	}

	drawShadows(placed) {
		const {gl} = this;
		gl.disable(gl.BLEND);
		gl.depthMask(true);
		gl.depthFunc(gl.LESS);
		this.bindMap(null);
		gl.bindFramebuffer(gl.FRAMEBUFFER, this.shadows.frame);
		gl.viewport(0, 0, 1024, 1024);
		gl.clear(gl.DEPTH_BUFFER_BIT);
		gl.enable(gl.POLYGON_OFFSET_FILL);
		gl.polygonOffset(2, 8);
		for (const item of placed) if (casts(item)) this.shape(item);
	}

	drawShapes(placed) {
		const {gl} = this;
		gl.bindFramebuffer(gl.FRAMEBUFFER, null);
		this.bindMap(this.shadows.map);
		gl.viewport(0, 0, this.canvas.width, this.canvas.height);
		gl.clearColor(...paint("sky"), 1);
		gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
		const grid = rounded(this.camera.radius/8);
		this.set({camera: this.matrix});
		for (const item of placed) {
			this.set({grid: item.shape.role === "ground" && !item.wall ? grid : 0});
			// An area is in the floor and covers it.
			gl.polygonOffset(...item.shape.role === "area" ? [-2, -8] : [0, 0]);
			this.shape(item);
		}
		gl.disable(gl.POLYGON_OFFSET_FILL);
	}

	drawMarks(trial, tick, visible) {
		const {gl} = this;
		gl.enable(gl.BLEND);
		gl.depthMask(false);
		this.set({plain: 0.6, grid: 0});
		// Hidden marks show faintly through shapes, because contacts are always between two of them.
		for (const [order, alpha] of [[gl.GREATER, 0.3], [gl.LEQUAL, 1]]) {
			gl.depthFunc(order);
			this.marks(trial, tick, visible, alpha);
		}
	}

	// Trails, rays, points and forces.
	marks(trial, tick, visible, alpha) {
		const {camera, thin} = this;
		const tint = (name, part = 1) => [...paint(name), alpha*part];
		if (visible.trails) {
			trailsAt(trial, tick, camera).forEach((trail, i) => {
				const {color, part, end} = trail;
				this.trail(trial, i, trail, tick, 1.4*thin, alpha*part);
				if (end) this.ball(end, 3.5*thin, [...color, alpha*part]);
			});
		}
		if (visible.rays) for (const {from, to, met} of trial.rays(tick)) this.line(from, to, thin, met ? tint("a") : tint("ray", 0.5));
		if (visible.points) trial.points.forEach((_, p) => this.ball(trial.point(tick, p), camera.radius*0.016, tint("point")));
		if (visible.forces) this.drawForces(trial.contacts(tick), tint("force"));
	}

	drawForces(contacts, color) {
		const {camera} = this;
		const {long, newtons} = camera.arrow();
		const thick = camera.radius*0.0065;
		for (const {point, force} of contacts) {
			this.ball(point, 1.6*thick, color);
			const arrow = mul(force, long/newtons);
			this.line(point, add(point, mul(arrow, min(1, camera.radius/hypot(...arrow)))), thick, color, 6*thick);
		}
	}

	// The past trail, and faintly the future one.
	trail(trial, i, {color}, tick, thick, alpha) {
		const {gl, made, camera: {radius}} = this;
		if (made.get(trial)?.radius !== radius) made.set(trial, {radius, ribbons: trial.trails.map(({path}) => ribbonOf(gl, thinned(path, radius)))});
		const {array, count, counts} = made.get(trial).ribbons[i];
		const past = counts.findLast(({t}) => t <= tick).count;
		gl.bindVertexArray(array);
		for (const [from, to, much] of [[0, past, 1], [past - 2, count, 0.3]]) {
			this.set({ribbon: thick, color: [...color, twice(alpha*much)]});
			gl.drawArrays(gl.TRIANGLE_STRIP, from, to - from);
		}
		this.set({ribbon: 0});
	}

	project(p) {
		return shownAt(this.matrix, p);
	}
}
