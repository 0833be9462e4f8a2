// The camera: matrices, bounds of visible shapes, and views.

const TAN = 0.3;
// Directions from the scene to the camera, by the names of `farsa draw`. `overview` depends on the moving bodies.
const VIEWS = {"overview": null, "three-quarter": [0.8, -0.75, 0.62], front: [1, 0, 0.3], side: [0, -1, 0.2], top: null, close: [1, -0.1, 0.34]};
// The width of the view `close` in radii of the thing.
const AROUND = 4.5;

// 1, 2 or 5 times a power of ten, not below x.
const rounded = (x) => {
	const power = 10**floor(log10(x));
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

// Transforms a place by a camera's matrix: right, up, depth, and the divisor.
const through = (matrix, p) => list(4, (r) => dot([matrix[r], matrix[r + 4], matrix[r + 8]], p) + matrix[r + 12]);
// The place in the picture from its upper left corner, in widths and heights, null behind the eye.
const shownAt = (matrix, p) => {
	const [x, y, , w] = through(matrix, p);
	return w > 0 ? [0.5 + x/w/2, 0.5 - y/w/2] : null;
};

const boundsOf = (balls) => [[min, -1], [max, 1]].map(([most, sign]) => [0, 1, 2].map((i) => most(...balls.map((b) => b.at[i] + sign*b.radius))));
const middleOf = ([low, high]) => mul(add(low, high), 0.5);
const spanOf = (balls) => hypot(...sub(...boundsOf(balls)));
const sizeOf = ({half, radius = 0, half_length: long = 0}) => (half ? hypot(...half) : radius + long);

// Prepares a trial. From above, every body of a robot counts as a robot.
function survey(trial, fromAbove) {
	const {ticks, bodies, shapes} = trial;
	const step = max(1, floor(ticks/60));
	const [floors, series] = [[], []];
	for (const {body, role, kind, half, radius = hypot(...half || []), half_length: long = 0, position, rotation} of shapes) {
		if (body < 0 && ["ground", "area"].includes(role)) {
			const [x, y] = half || [radius, radius];
			if (kind !== "plane") for (const s of [-1, 1]) floors.push({at: add(position, [s*x, s*y, 0]), radius: 0});
			continue;
		}
		// A long shape counts by its two ends, so that the view is no wider than needed.
		for (const z of new Set([-long, long])) {
			series.push(list(body < 0 ? 1 : ceil(ticks/step), (k) => {
				const pose = body < 0 ? HOME : trial.pose(k*step, body);
				const at = add(pose.position, turn(pose.rotation, add(position, turn(rotation, [0, 0, z]))));
				return {at, radius, thing: role === "thing", body, t: k*step};
			}));
		}
	}
	if (!series[0]) series.push([{at: [0, 0, 0], radius: 1}]);
	const balls = series.flat();
	// The parts that move, and things.
	const ways = series.map((some) => spanOf(some.map(({at}) => ({at, radius: 0}))));
	const focus = series.filter((some, i) => some[0].thing || ways[i] >= 0.2*max(...ways)).flat();
	// Only the farthest moving body of a robot of many bodies has a trail.
	const own = (body) => shapes.filter((s) => s.body === body && s.color && s.role !== "area").sort((a, b) => sizeOf(b) - sizeOf(a))[0]?.color;
	const moving = bodies.flatMap((name, body) => {
		const role = shapes.find((s) => s.body === body)?.role;
		const path = [];
		if (role) for (let t = 0; t < ticks; t += max(1, floor(ticks/1500))) path.push({t, at: trial.pose(t, body).position});
		const way = max(...path.map(({at}) => hypot(...sub(at, path[0].at))));
		return way > 1e-3 ? [{name, body, path, way, top: 2*max(...balls.filter((b) => b.body === body).map((b) => b.radius)), thing: role === "thing", tint: own(body)}] : [];
	});
	const robot = moving.filter((m) => !m.thing).sort((a, b) => b.way - a.way);
	// Robots of one color get different trails.
	if (new Set(robot.map(({tint}) => tint)).size < robot.length) for (const one of robot) one.tint = WORDS[one.body%WORDS.length];
	const trails = [...moving.filter((m) => m.thing), ...robot.slice(0, fromAbove ? 24 : robot.length > 6 ? 1 : 6)];
	const forces = list(ticks, (t) => trial.contacts(t).map((c) => hypot(...c.force))).flat().sort((a, b) => a - b);
	const has = {forces: forces.length, points: trial.points.length, rays: trial.rayStarts.some((start) => trial.words[start])};
	// A robot that travels far is followed, and its parts are seen relative to its first body.
	const [root] = fromAbove ? [] : moving.filter((m) => !m.thing);
	const parts = root ? focus.map((ball) => ({...ball, at: sub(ball.at, trial.pose(ball.t, root.body).position)})) : focus;
	const travels = spanOf(focus) > 2.5*spanOf(parts) ? {body: root.body, balls: parts} : null;
	assign(trial, {balls, bounds: boundsOf(balls), focus, floors, moving, trails, travels, has, force: forces[floor(forces.length*0.95)] || 1});
}

// One camera for both views, so that trials are compared from the same viewpoint.
class Camera {
	constructor(top) {
		assign(this, {name: top ? "top" : "overview", top, followed: null, carried: null});
	}

	axes(top = this.top) {
		const [level, {yaw, pitch}] = [cos(this.pitch), this];
		return top ? [[1, 0, 0], [0, 1, 0], [0, 0, 1]] : axesOf([cos(yaw)*level, sin(yaw)*level, sin(pitch)]);
	}

	// Fits the view to what moves, with things in front or from a named direction. `near` is the present place of a thing, `place`
	// that of the followed body.
	frame(trials, aspect, near, place) {
		this.top = this.name === "top";
		const carried = place && trials.some(({travels}) => travels?.body === this.followed) ? place : null;
		const focused = (trial) => (carried ? (trial.travels?.balls ?? []).map((ball) => ({...ball, at: add(ball.at, carried)})) : this.top ? trial.balls : trial.focus);
		const all = trials.flatMap(focused);
		const bounds = boundsOf(all);
		const middle = middleOf(bounds);
		this.force = max(...trials.map((trial) => trial.force));
		const things = all.filter((b) => b.thing);
		const [x, y] = sub(middleOf(boundsOf(things.length ? things : all)), middle);
		const named = VIEWS[this.name];
		this.yaw = named ? Math.atan2(named[1], named[0]) : Math.atan2(y, x || 1e-9) - 0.75;
		this.pitch = named ? Math.asin(unit(named)[2]) : 0.42;
		this.radius = max(1e-6, ...all.map((b) => hypot(...sub(b.at, middle)) + b.radius));
		const [right, up, back] = this.axes(false);
		this.target = middle;
		for (const axis of [right, up]) {
			const along = all.map(({at, radius}) => ({at: [dot(sub(at, middle), axis), 0, 0], radius}));
			this.target = add(this.target, mul(axis, middleOf(boundsOf(along))[0]));
		}
		this.distance = max(...all.map(({at, radius}) => {
			const p = sub(at, this.target);
			return dot(p, back) + max((abs(dot(p, right)) + radius)/aspect, abs(dot(p, up)) + radius)/(TAN*0.88);
		}));
		if (this.name === "close" && near) {
			this.target = near;
			this.distance = AROUND*things[0].radius/(TAN*min(1, aspect));
		}
		// The view from above includes walls and areas, unless they are much larger than the moving bodies.
		const span = ([low, high]) => max(high[0] - low[0], high[1] - low[1]);
		const wide = boundsOf([...all, ...carried ? [] : trials.flatMap((trial) => trial.floors)]);
		const flat = span(wide) < 4*span(bounds) ? wide : bounds;
		this.middle = middleOf(flat);
		this.half = 0.54*max(flat[1][1] - flat[0][1], (flat[1][0] - flat[0][0])/aspect, 1e-6);
		this.carried = carried;
	}

	// Moves with the followed body at this place. Centers it first, except from above.
	carry(place) {
		const way = place && (this.carried ? sub(place, this.carried) : this.top ? [0, 0, 0] : sub(place, this.target));
		if (way) {
			this.target = add(this.target, way);
			this.middle = add(this.middle, [way[0], way[1], 0]);
		}
		this.carried = place;
	}

	// Centers a place.
	centre(place) {
		this[this.top ? "middle" : "target"] = place;
	}

	// The start and direction of a ray through a place of the picture, in half heights from its middle.
	ray(x, y) {
		const [right, up, back] = this.axes();
		const aside = add(mul(right, x), mul(up, y));
		if (this.top) return [add(add(this.middle, mul(aside, this.half)), mul(back, 100*this.radius)), mul(back, -1)];
		return [add(this.target, mul(back, this.distance)), unit(sub(mul(aside, TAN), back))];
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

	// Zooms around a place, with x and y in half heights of the picture from its middle.
	zoom(factor, x, y) {
		const [right, up] = this.axes();
		const [what, size, tan] = this.top ? ["middle", "half", 1] : ["target", "distance", TAN];
		this[what] = add(this[what], mul(add(mul(right, x), mul(up, y)), tan*this[size]*(1 - factor)));
		this[size] *= factor;
	}

	// Round numbers for the legend.
	arrow() {
		return {long: rounded(this.radius*0.12), newtons: rounded(this.force*0.4)};
	}
}
