// The scene of a trial where there is no WebGL 2: shapes with shades on a plain canvas, painted from the back to the front.

const CIRCLE = list(32, (i) => [cos(i*Math.PI/16), sin(i*Math.PI/16)]);
const ink = (color, alpha = 1) => `rgba(${color.slice(0, 3).map((x) => round(255*min(1, x)))},${alpha})`;
const mixed = (a, b, part) => add(mul(a, 1 - part), mul(b, part));
// As the shader of Scene lights it, where nothing keeps the sun away.
const lit = (color, n, to) => mul(color, 0.38 + 0.1*n[2] + 0.18*dot(n, to) + 0.36*max(0, dot(n, SUN)));

// The convex outline of places in the picture.
function hullOf(places) {
	const half = (some) => some.reduce((made, p) => {
		const bends = ([a, b]) => (b[0] - a[0])*(p[1] - a[1]) > (b[1] - a[1])*(p[0] - a[0]);
		while (made[1] && !bends(made.slice(-2))) made.pop();
		return [...made, p];
	}, []).slice(1);
	places.sort((a, b) => a[0] - b[0] || a[1] - b[1]);
	return [...half(places), ...half(places.reverse())];
}

// Places of which a placed shape is the hull; what is round has its outline as seen along the last of these axes.
function cornersOf({shape: {kind, half, radius: r, half_length: long = 0}, origin, rotation}, axes) {
	const out = (p) => add(origin, turn(rotation, p));
	if (kind === "box") return list(8, (i) => out(half.map((h, k) => (i >> k & 1 ? h : -h))));
	const [a, b] = kind === "cylinder" ? [[1, 0, 0], [0, 1, 0]].map((axis) => turn(rotation, axis)) : axes;
	return [-long, long].flatMap((z) => CIRCLE.map(([c, s]) => add(out([0, 0, z]), add(mul(a, r*c), mul(b, r*s)))));
}

class Flat extends Scene {
	open(canvas) {
		this.c = canvas.getContext("2d", {alpha: false});
		need(this.c, "no context");
	}

	draw(trial, tick, camera, visible) {
		const {c, canvas: {width, height}} = this;
		this.look(trial, tick, camera);
		Object.assign(this, {axes: camera.axes(), near: camera.top ? 0 : camera.distance/50});
		Object.assign(c, {lineJoin: "round", lineCap: "round", fillStyle: ink(paint("sky"))});
		c.fillRect(0, 0, width, height);
		const floors = this.placed.some(({shape, wall}) => shape.role === "ground" && !wall);
		// An area is part of the floor.
		this.items = this.placed.filter(({shape}) => shape.role !== "area" || !floors).flatMap((item) => this.outline(item));
		for (const item of this.sorted()) this.shape(item);
		this.marks(trial, tick, visible, 1);
	}

	// Pixels of the picture, and the depth.
	pixel(p) {
		const [x, y, , w] = through(this.matrix, p);
		const by = 2*w || 1;
		return [(0.5 + x/by)*this.canvas.width, (0.5 - y/by)*this.canvas.height, w];
	}

	// How many pixels a metre has there.
	scale(p) {
		const {camera: {top, half}, canvas, near} = this;
		return canvas.height/2/(top ? half : TAN*max(near, this.pixel(p)[2]));
	}

	toEye(p) {
		return this.camera.top ? this.axes[2] : unit(sub(this.eye, p));
	}

	// The part of a polygon or line that is before the eye, in pixels.
	cut(places) {
		const depths = places.map((p) => through(this.matrix, p)[3] - this.near);
		return places.flatMap((p, i) => {
			const k = (i + 1)%places.length;
			const edge = depths[i] > 0 === depths[k] > 0 ? [] : [mixed(p, places[k], depths[i]/(depths[i] - depths[k]))];
			return depths[i] > 0 ? [p, ...edge] : edge;
		}).map((p) => this.pixel(p));
	}

	trace(pixels) {
		pixels.forEach(([x, y], i) => this.c[i ? "lineTo" : "moveTo"](x, y));
	}

	fill(pixels, style) {
		const {c} = this;
		c.beginPath();
		this.trace(pixels);
		c.closePath();
		// With an edge, so that faces that meet leave no gap.
		Object.assign(c, {fillStyle: style, strokeStyle: style, lineWidth: 0.6});
		c.fill();
		c.stroke();
	}

	// A shape with its outline and what encloses it in the picture; none behind the eye or aside.
	outline(item) {
		const {canvas: {width, height}, near} = this;
		const far = hypot(...sub(this.eye, item.origin));
		const box = [0, 0, width, height];
		if (item.shape.kind === "plane") return {...item, far, box};
		const corners = cornersOf(item, this.axes);
		const before = corners.map((p) => this.pixel(p)).filter(([, , w]) => w > near);
		const hull = hullOf(before);
		if (before.length === corners.length) box.forEach((_, i) => (box[i] = (i < 2 ? min : max)(...hull.map((p) => p[i%2]))));
		return hull.length && box[0] < width && box[1] < height && box[2] > 0 && box[3] > 0 ? {...item, far, hull, corners, box} : [];
	}

	// Whether a is farther than b where one hides the other: found by rays through what both enclose.
	behind(a, b) {
		const {canvas: {width, height}, camera} = this;
		const [left, top, right, low] = a.box.map((x, i) => (i < 2 ? max : min)(x, b.box[i]));
		if (left >= right || top >= low) return false;
		for (const k of [4, 0, 8, 2, 6, 1, 3, 5, 7]) {
			const [x, y] = [left + (right - left)*(k%3*2 + 1)/6, top + (low - top)*(floor(k/3)*2 + 1)/6];
			const ray = camera.ray((2*x - width)/height, 1 - 2*y/height);
			const [far, near] = [a, b].map((item) => metAt(item, ...ray));
			if (far < Infinity && near < Infinity) return far > near;
		}
		return false;
	}

	// From the back to the front.
	sorted() {
		const rest = new Set(this.items.sort((a, b) => b.far - a.far));
		const made = [];
		const take = (item) => {
			if (!rest.delete(item)) return;
			for (const other of rest) if (this.behind(other, item)) take(other);
			made.push(item);
		};
		this.items.forEach(take);
		return made;
	}

	shape(item) {
		const {shape: {kind, half, half_length: long}, origin, rotation, color, hull, corners} = item;
		if (kind === "plane") return this.plane(item);
		if (kind !== "box") this.fill(hull, this.shades(item));
		// Its faces, three of a box by the bits of their corners.
		for (const k of {box: [0, 1, 2], cylinder: [2]}[kind] || []) for (const s of [0, 1]) {
			const n = turn(rotation, list(3, (i) => (i === k ? 2*s - 1 : 0)));
			const middle = add(origin, mul(n, half ? half[k] : long));
			const to = this.toEye(middle);
			if (dot(n, to) <= 0) continue;
			const [i, j] = [1 << (k + 1)%3, 1 << (k + 2)%3];
			const face = half ? [0, i, i + j, j].map((bits) => corners[bits + (s << k)]) : corners.slice(32*s, 32*s + 32);
			this.fill(this.cut(face), ink(lit(color, n, to)));
			if (n[2] > 0.9) this.floor(item, face, middle[2]);
		}
	}

	// The light on what is round: across what is long, else around where the sun stands.
	shades({shape: {kind, radius: r, half_length: long = 0}, origin, rotation, color}) {
		const {c, axes} = this;
		const to = this.toEye(origin);
		const across = cross(to, turn(rotation, [0, 0, 1]));
		const tube = (kind === "cylinder" || long > r) && hypot(...across) > 0.1;
		const side = unit(tube ? across : sub(SUN, mul(to, dot(SUN, to))));
		// From the brightest place on a ball, or from an edge.
		const start = tube || dot(SUN, to) < 0 ? 1 : dot(SUN, side);
		const size = (tube ? r : r + long)*this.scale(origin);
		const [x, y] = this.pixel(origin);
		const [u, v] = [size*dot(side, axes[0]), -size*dot(side, axes[1])];
		const from = [x + start*u, y + start*v];
		const shades = tube ? c.createLinearGradient(...from, x - u, y - v)
			: c.createRadialGradient(...from, 0, ...from, size*(1 + start));
		for (const k of list(9, (k) => k/8)) {
			const a = start - k*(1 + start);
			shades.addColorStop(k, ink(lit(color, add(mul(side, a), mul(to, Math.sqrt(max(0, 1 - a*a)))), to)));
		}
		return shades;
	}

	// A ground without end, which fades out far from what moves.
	plane(item) {
		const {middle: [x, y], reach} = this;
		const [, , z] = item.origin;
		const ring = (r) => CIRCLE.map(([c, s]) => [x + r*c, y + r*s, z]);
		if (this.eye[2] < z) return;
		const shade = lit(item.color, [0, 0, 1], this.toEye([x, y, z]));
		for (const k of list(17, (k) => k/16)) {
			this.fill(this.cut(ring(reach*(1 - 0.55*k))), ink(mixed(paint("sky"), shade, k*k*(3 - 2*k))));
		}
		this.floor(item, ring(reach*0.45), z);
	}

	// On a face of the ground that looks up: its grid, areas, and the shadows of what is above it.
	floor({shape: {role}, wall, color: [r, g, b]}, face, z) {
		const {c, camera: {radius}, middle} = this;
		if (wall || role !== "ground") return;
		c.save();
		c.beginPath();
		this.trace(this.cut(face));
		c.clip();
		const line = r + g + b > 1.2 ? 0 : 1;
		Object.assign(c, {strokeStyle: ink([line, line, line], 0.1), lineWidth: 1});
		for (const [times, many] of [[1, 60], [5, 20]]) {
			const gap = times*rounded(radius/8);
			c.beginPath();
			for (const i of [0, 1]) for (let k = -many; k <= many; k++) {
				const at = (along) => list(3, (j) => (j === 2 ? z : (round(middle[j]/gap) + (j === i ? k : along*many))*gap));
				this.trace(this.cut([at(-1), at(1)]));
			}
			c.stroke();
		}
		for (const item of this.placed) {
			const {shape: {role, half}, origin, color} = item;
			if (role !== "area" || abs(origin[2] - z) > 0.05*radius) continue;
			const top = cornersOf(item, this.axes).slice(half ? 4 : 32);
			this.fill(hullOf(this.cut(top)), ink(lit(color, [0, 0, 1], this.toEye(origin))));
		}
		c.beginPath();
		for (const item of this.placed) {
			if (!casts(item)) continue;
			const fallen = cornersOf(item, axesOf(SUN)).map(([x, y, up]) => {
				const far = max(0, up - z)/SUN[2];
				return this.pixel([x - SUN[0]*far, y - SUN[1]*far, z]);
			});
			if (fallen.every(([, , w]) => w > this.near)) this.trace(hullOf(fallen));
		}
		c.fillStyle = "rgba(0,0,0,.25)";
		c.fill();
		c.restore();
	}

	// Whether a shape is before a place.
	hidden(p) {
		const {camera: {radius, top}, eye} = this;
		const [x, y] = this.pixel(p);
		const to = this.toEye(p);
		const far = top ? 100*radius : hypot(...sub(eye, p));
		return this.items.some((item) => {
			const [left, up, right, low] = item.box;
			if (x < left || x > right || y < up || y > low) return false;
			const met = metAt(item, add(p, mul(to, far)), mul(to, -1));
			return met > 0 && met < far - 0.02*radius;
		});
	}

	// Faint where a shape is before its middle.
	lines(pieces, wide, color, alpha) {
		const {c} = this;
		const hidden = pieces.map(([a, b]) => this.hidden(mixed(a, b, 0.5)));
		for (const under of [true, false]) {
			c.beginPath();
			pieces.forEach((piece, i) => hidden[i] === under && this.trace(this.cut(piece)));
			Object.assign(c, {strokeStyle: ink(color, twice(under ? 0.3*alpha : alpha)), lineWidth: wide});
			c.stroke();
		}
	}

	trail(trial, i, {path, color}, tick, thick, alpha) {
		const {camera: {radius, target}} = this;
		const kept = thinned(path, radius);
		const wide = 2*thick*this.scale(target);
		for (const past of [false, true]) {
			const pieces = kept.flatMap(({t, at}, k) => (k && t <= tick === past ? [[kept[k - 1].at, at]] : []));
			this.lines(pieces, wide, color, past ? alpha : 0.3*alpha);
		}
	}

	line(a, b, thick, color, head = 0) {
		const size = thick*this.scale(a);
		this.lines([[a, b]], 2*size, color, color[3]);
		const [[x, y, w], [from, down]] = [b, a].map((p) => this.pixel(p));
		if (!head || w <= this.near) return;
		const [u, v] = unit([x - from, y - down, 0]).map((x) => x*size);
		const tip = [[2, 0], [-4, 2.4], [-4, -2.4]].map(([i, j]) => [x + i*u - j*v, y + i*v + j*u]);
		this.fill(tip, ink(color, this.hidden(b) ? 0.5 : 1));
	}

	ball(p, r, color) {
		const {c, near} = this;
		const [x, y, w] = this.pixel(p);
		if (w <= near) return;
		c.beginPath();
		c.arc(x, y, r*this.scale(p), 0, 7);
		c.fillStyle = ink(color, twice(this.hidden(p) ? 0.3*color[3] : color[3]));
		c.fill();
	}
}
