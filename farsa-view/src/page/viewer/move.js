// Bodies that are moved or pushed by hand.

// The duration of a push [s].
const PUSH = 0.1;

// The mass of a thing or robot with the density of water [kg].
function weightOf({shapes}, body) {
	const thing = shapes.find((shape) => shape.body === body).role === "thing";
	const own = shapes.filter((shape) => (thing ? shape.body === body : shape.role === "robot" && shape.body >= 0));
	return own.reduce((sum, {kind, half, radius: r, half_length: long = 0}) => {
		const round = 2*PI*r*r*long + (kind === "cylinder" ? 0 : 4/3*PI*r**3);
		return sum + 1000*(half ? 8*half[0]*half[1]*half[2] : round);
	}, 0);
}

// While `grip()` is "move" or "push", a body that is taken in a view follows the pointer in a plane or is pulled toward it. Keys act
// on `own.body`. The result is passed to `put` or `push`.
function carry(player, grip, own, {put, push, say}) {
	const views = $("views");
	let held = null;

	// The ray under the pointer.
	function rayOf({clientX, clientY}, canvas) {
		const {left, top, width, height} = canvas.getBoundingClientRect();
		return player.camera.ray((2*(clientX - left) - width)/height, 1 - 2*(clientY - top)/height);
	}

	// Takes a body at a point.
	function hold(trial, body, point, more) {
		player.pause();
		const pose = trial.between(player.tickOf(trial), body);
		held = {trial, body, ...pose, point, offset: sub(pose.position, point), pushes: grip() === "push", ...more};
	}

	// Moves or pulls the body.
	function bring(way) {
		const {trial, body, point, offset, pushes} = held;
		if (pushes) {
			// The force that moves this mass to the pointer in half the duration of a push. The arrow ends at the pointer.
			const {long, newtons} = player.camera.arrow();
			held.force = mul(way, weightOf(trial, body)*4/PUSH**2);
			trial.pull = {pair: [trial.bodies[body], "outside"], point, force: mul(way, newtons/long)};
		} else trial.held = assign(held, {position: add(add(point, way), offset)});
		player.ask();
	}

	function leave(done) {
		if (!held) return;
		const {trial, body, position, rotation, offset, force} = held;
		const [moved, pull, step] = [trial.held, trial.pull, player.at(trial) + 1];
		trial.held = trial.pull = held = null;
		if (done && moved) put({step, body, position, rotation}, trial);
		if (done && pull) push({step, body, point: turn([...mul(rotation, -1).slice(0, 3), rotation[3]], mul(offset, -1)), force}, trial);
		player.ask();
	}

	function take(event) {
		const at = player.views.findIndex(({canvas}) => canvas === event.target);
		const trial = player.shown[at];
		leave(false);
		if (!grip() || !trial) return;
		player.pause();
		const [from, along] = rayOf(event, event.target);
		const met = placedAt(trial, player.tickOf(trial)).map((item) => [metAt(item, from, along), item.shape.body]);
		const [near, body] = met.filter(([t]) => t > 0).sort((a, b) => a[0] - b[0])[0] ?? [];
		if (!(body >= 0) || !(near < Infinity)) return;
		event.stopPropagation();
		event.target.setPointerCapture(event.pointerId);
		// Bodies are moved level with the ground, and pushed in the plane of the picture.
		hold(trial, body, add(from, mul(along, near)), {canvas: event.target, normal: grip() === "push" ? along : [0, 0, 1]});
	}

	function drag(event) {
		if (!held?.canvas) return;
		event.stopPropagation();
		const [from, along] = rayOf(event, held.canvas);
		const far = dot(sub(held.point, from), held.normal)/dot(along, held.normal);
		if (far > 0 && far < 1e4) bring(sub(add(from, mul(along, far)), held.point));
	}

	const release = (done) => (event) => {
		if (!held?.canvas) return;
		event.stopPropagation();
		leave(done);
	};

	// Moves along the sides of the picture, level with the ground, and up.
	function press(event) {
		const {key, target, shiftKey} = event;
		const [right] = player.camera.axes(), up = [0, 0, 1];
		const ahead = cross(up, right);
		const way = {ArrowLeft: mul(right, -1), ArrowRight: right, ArrowUp: ahead, ArrowDown: mul(ahead, -1), PageUp: up, PageDown: [0, 0, -1]}[key];
		const other = {"[": -1, "]": 1}[key];
		const known = way || other || held && ["Enter", "Escape"].includes(key);
		if (!known || !grip() || target.matches("select, input") || $("keys").open || event.ctrlKey || event.metaKey || event.altKey) return;
		event.preventDefault();
		event.stopPropagation();
		if (!way) leave(key === "Enter");
		const {body: {options, selectedIndex: at}} = own;
		if (other) say(options[own.body.selectedIndex = (at + other + options.length)%options.length].textContent);
		if (!way) return;
		const [trial, body] = [player.shown[0], +own.body.value];
		if (!held) hold(trial, body, placedAt(trial, player.tickOf(trial)).find(({shape}) => shape.body === body).origin, {way: [0, 0, 0]});
		held.way = add(held.way, mul(way, rounded(player.camera.radius*0.02)*(shiftKey ? 10 : 1)));
		bring(held.way);
		say(`${trial.bodies[body]}, ${held.pushes ? short(hypot(...held.force), "N") : length(hypot(...held.way))}: Enter applies it, Escape cancels it.`);
	}

	for (const [name, act] of [["down", take], ["move", drag], ["up", release(true)], ["cancel", release(false)]]) views.addEventListener(`pointer${name}`, act, true);
	addEventListener("keydown", press, true);
	own.body.onchange = () => leave(false);
	return leave;
}

const HANDS = `
while bodies of the first trial are moved or pushed
[ ]         another body
arrows      move or pull it along the ground
Page \u2191 \u2193    up, down, ten times as far with shift
Enter Esc   apply, cancel
`;

// Bodies can be dragged or pushed while the button is pressed. Returns functions for both.
function movable(page, player, state, own, show, say) {
	const {about} = page.live, {move: moving, push: pushing} = own;
	const grip = () => (isPressed(moving) ? "move" : isPressed(pushing) ? "push" : "");
	// Things first, then robots.
	const {bodies, shapes} = page.trials[0];
	const some = ["thing", "robot"].flatMap((role) => shapes.filter((shape) => shape.role === role && shape.body >= 0).map((shape) => shape.body));
	own.body.replaceChildren(...options([...new Set(some)].map((body) => [body, bodies[body]])));
	const leave = carry(player, grip, own, {put, push, say});
	for (const [one, other] of [[moving, pushing], [pushing, moving]]) {
		one.onclick = () => {
			leave(false);
			setPressed(one, !isPressed(one));
			setPressed(other, false);
			own.body.hidden = !grip();
			say(grip() ? "Drag a body, or press arrows and then Enter." : "");
		};
	}
	const timeOf = (trial, step) => trial.times[min(step, trial.ticks) - 1];

	// Runs the trial again with the body moved.
	async function put(move, trial) {
		const name = trial.bodies[move.body];
		state.moves = [...state.moves, {...move, what: `${name} moved`, time: timeOf(trial, move.step)}];
		await show();
		const [whole, moved] = page.trials;
		if (!moved || move.step >= min(whole.ticks, moved.ticks)) return;
		const [from, to] = [whole, moved].map((one) => one.pose(move.step, move.body).position);
		if (hypot(...sub(to, from)) < 0.1*hypot(...sub(move.position, from))) say(`${name} is attached by a joint and cannot be moved.`);
	}

	// Runs the trial again with a push.
	function push({step, body, point, force}, trial) {
		const {times} = trial;
		const long = max(1, round(PUSH/(times[1] - times[0]) || 1));
		const what = `${trial.bodies[body]} pushed by ${short(hypot(...force), "N")}`;
		state.pushes = [...state.pushes, {steps: [step, step + long], body, point, force, what, time: timeOf(trial, step)}];
		return show();
	}

	moving.hidden = !about.displaces;
	pushing.hidden = !about.pushes;
	own.body.hidden = true;
	if (about.displaces || about.pushes) $("keys").querySelector("pre").append(HANDS);
	return {put, push};
}
