// Bodies that are put elsewhere by hand.

// While `on()`, a body that is taken in a view follows the pointer in the plane in which it was taken, and `put` hears where
// it was left.
function carry(player, on, put) {
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
		if (!on() || !trial) return;
		player.pause();
		const [from, along] = rayOf(event, event.target);
		const met = placedAt(trial, player.tickOf(trial)).map((item) => [metAt(item, from, along), item.shape.body]);
		const [near, body] = met.filter(([t]) => t > 0).sort((a, b) => a[0] - b[0])[0] ?? [];
		if (!(body >= 0) || !(near < Infinity)) return;
		event.stopPropagation();
		event.target.setPointerCapture(event.pointerId);
		const pose = trial.between(player.tickOf(trial), body);
		const grip = add(from, mul(along, near));
		held = {trial, body, ...pose, grip, canvas: event.target, offset: sub(pose.position, grip)};
	}

	function drag(event) {
		if (!held) return;
		event.stopPropagation();
		const [from, along] = rayOf(event, held.canvas);
		const far = (held.grip[2] - from[2])/along[2];
		if (!(far > 0 && far < 1e4)) return;
		held.position = add(add(from, mul(along, far)), held.offset);
		held.trial.held = held;
		player.ask();
	}

	function leave(event) {
		if (!held) return;
		event.stopPropagation();
		const {trial, body, position, rotation} = held;
		const moved = trial.held;
		trial.held = held = null;
		if (moved && event.type === "pointerup") put({step: player.at(trial) + 1, body, position, rotation}, trial);
		player.ask();
	}

	for (const [name, act] of [["down", take], ["move", drag], ["up", leave], ["cancel", leave]]) views.addEventListener(`pointer${name}`, act, true);
}

// Bodies can be dragged while the button is pressed; gives what puts one elsewhere.
function movable(page, player, state, pressed, show, say) {
	// The trial runs anew with the body there.
	async function put(move, trial) {
		const name = trial.bodies[move.body];
		state.moves = [...state.moves, {...move, name, time: trial.times[move.step - 1]}];
		await show();
		const [whole, moved] = page.trials;
		if (!moved || move.step >= min(whole.ticks, moved.ticks)) return;
		const [from, to] = [whole, moved].map((one) => one.pose(move.step, move.body).position);
		if (hypot(...sub(to, from)) < 0.1*hypot(...sub(move.position, from))) say(`${name} hangs on something and stays where it is.`);
	}

	pressed.hidden = !page.live.about.displaces;
	carry(player, () => pressed.getAttribute("aria-pressed") === "true", put);
	return put;
}
