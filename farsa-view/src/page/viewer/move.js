// Bodies that are put elsewhere or pushed by hand.

// How long a push lasts [s].
const PUSH = 0.1;

// What a thing or a whole robot weighs if it is as dense as water [kg].
function weightOf({shapes}, body) {
	const thing = shapes.find((shape) => shape.body === body).role === "thing";
	const own = shapes.filter((shape) => (thing ? shape.body === body : shape.role === "robot"));
	return own.reduce((sum, {kind, half, radius: r, half_length: long = 0}) => {
		const round = 2*Math.PI*r*r*long + (kind === "cylinder" ? 0 : 4/3*Math.PI*r**3);
		return sum + 1000*(kind === "box" ? 8*half[0]*half[1]*half[2] : round);
	}, 0);
}

// While `grip()` is "move" or "push", a body that is taken in a view follows the pointer in the plane in which it was taken, or is
// pulled towards it; `put` and `push` hear what came of it.
function carry(player, grip, put, push) {
	const views = $("views");
	let held = null;

	// The ray under the pointer.
	function rayOf({clientX, clientY}, canvas) {
		const {left, top, width, height} = canvas.getBoundingClientRect();
		return player.camera.ray((2*(clientX - left) - width)/height, 1 - 2*(clientY - top)/height);
	}

	function take(event) {
		const at = player.views.findIndex(({canvas}) => canvas === event.target);
		const trial = player.shown[at];
		if (!grip() || !trial) return;
		player.pause();
		const [from, along] = rayOf(event, event.target);
		const met = placedAt(trial, player.tickOf(trial)).map((item) => [metAt(item, from, along), item.shape.body]);
		const [near, body] = met.filter(([t]) => t > 0).sort((a, b) => a[0] - b[0])[0] ?? [];
		if (!(body >= 0) || !(near < Infinity)) return;
		event.stopPropagation();
		event.target.setPointerCapture(event.pointerId);
		const pose = trial.between(player.tickOf(trial), body);
		const point = add(from, mul(along, near));
		// Bodies are moved level with the ground, and pushed in the plane of the picture.
		held = {trial, body, ...pose, point, canvas: event.target, offset: sub(pose.position, point), pushes: grip() === "push", normal: grip() === "push" ? along : [0, 0, 1]};
	}

	function drag(event) {
		if (!held) return;
		event.stopPropagation();
		const {trial, point, normal} = held;
		const [from, along] = rayOf(event, held.canvas);
		const far = dot(sub(point, from), normal)/dot(along, normal);
		if (!(far > 0 && far < 1e4)) return;
		const to = add(from, mul(along, far));
		if (held.pushes) {
			// As much as moves what weighs so much there in half the time that a push lasts; the arrow reaches to the pointer.
			const [way, {long, newtons}] = [sub(to, point), player.camera.arrow()];
			held.force = mul(way, weightOf(trial, held.body)*4/PUSH**2);
			trial.pull = {pair: [trial.bodies[held.body], "outside"], point, force: mul(way, newtons/long)};
		} else trial.held = Object.assign(held, {position: add(to, held.offset)});
		player.ask();
	}

	function leave(event) {
		if (!held) return;
		event.stopPropagation();
		const {trial, body, position, rotation, offset, force} = held;
		const [moved, pull, step] = [trial.held, trial.pull, player.at(trial) + 1];
		trial.held = trial.pull = held = null;
		if (event.type === "pointerup" && moved) put({step, body, position, rotation}, trial);
		if (event.type === "pointerup" && pull) push({step, body, point: turn([...mul(rotation, -1).slice(0, 3), rotation[3]], mul(offset, -1)), force}, trial);
		player.ask();
	}

	for (const [name, act] of [["down", take], ["move", drag], ["up", leave], ["cancel", leave]]) views.addEventListener(`pointer${name}`, act, true);
}

// Bodies can be dragged or pushed while its button is pressed; gives what does either.
function movable(page, player, state, {move: moving, push: pushing}, show, say) {
	const {about} = page.live;
	const on = (one) => one.getAttribute("aria-pressed") === "true";
	for (const [one, other] of [[moving, pushing], [pushing, moving]]) {
		one.onclick = () => (one.setAttribute("aria-pressed", !on(one)), other.setAttribute("aria-pressed", false));
	}
	const timeOf = (trial, step) => trial.times[min(step, trial.ticks) - 1];

	// The trial runs anew with the body there.
	async function put(move, trial) {
		const name = trial.bodies[move.body];
		state.moves = [...state.moves, {...move, what: `${name} moved`, time: timeOf(trial, move.step)}];
		await show();
		const [whole, moved] = page.trials;
		if (!moved || move.step >= min(whole.ticks, moved.ticks)) return;
		const [from, to] = [whole, moved].map((one) => one.pose(move.step, move.body).position);
		if (hypot(...sub(to, from)) < 0.1*hypot(...sub(move.position, from))) say(`${name} hangs on something and stays where it is.`);
	}

	// And with a force on it for a moment.
	function push({step, body, point, force}, trial) {
		const {times} = trial;
		const long = max(1, round(PUSH/(times[1] - times[0]) || 1));
		const what = `${trial.bodies[body]} pushed by ${short(hypot(...force), "N")}`;
		state.pushes = [...state.pushes, {steps: [step, step + long], body, point, force, what, time: timeOf(trial, step)}];
		return show();
	}

	moving.hidden = !about.displaces;
	pushing.hidden = !about.pushes;
	carry(player, () => (on(moving) ? "move" : on(pushing) ? "push" : ""), put, push);
	return {put, push};
}
