// A trial in a figure of the page: its picture with labels, and gestures that move the camera.

// Turns, moves and zooms the camera by mouse, fingers and wheel.
function steer(canvas, camera, ask, centre) {
	const fingers = new Map();
	// Half heights from the middle, upwards.
	const placeOf = ({clientX, clientY}) => {
		const {left, top, width, height} = canvas.getBoundingClientRect();
		return [(2*(clientX - left) - width)/height, 1 - 2*(clientY - top)/height];
	};
	canvas.ondblclick = (event) => centre(...placeOf(event));
	canvas.onpointerdown = (event) => {
		fingers.set(event.pointerId, event);
		canvas.setPointerCapture(event.pointerId);
	};
	canvas.onpointerup = canvas.onpointercancel = (event) => fingers.delete(event.pointerId);
	canvas.oncontextmenu = (event) => event.preventDefault();
	canvas.onpointermove = (event) => {
		const last = fingers.get(event.pointerId);
		if (!last) return;
		const height = canvas.clientHeight;
		const [dx, dy] = [event.clientX - last.clientX, event.clientY - last.clientY];
		const other = [...fingers.values()].find((f) => f.pointerId !== event.pointerId);
		if (other) {
			const gap = (f) => hypot(f.clientX - other.clientX, f.clientY - other.clientY) || 1;
			camera.zoom(gap(last)/gap(event), ...placeOf({clientX: (event.clientX + other.clientX)/2, clientY: (event.clientY + other.clientY)/2}));
			// Each finger contributes half of the movement.
			camera.pan(dx/2/height, dy/2/height);
		} else if (camera.top || event.shiftKey || event.buttons & 6) camera.pan(dx/height, dy/height);
		else camera.turn(dx, dy);
		fingers.set(event.pointerId, event);
		ask();
	};
	canvas.addEventListener("wheel", (event) => {
		event.preventDefault();
		camera.zoom(Math.exp(event.deltaY*(event.deltaMode ? 0.02 : 0.0012)), ...placeOf(event));
		ask();
	}, {passive: false});
}

const namesOf = (trails) => trails.slice(0, 4).map((trail) => trail.name).join(", ") + (trails[4] ? " ..." : "") || "nothing moves";

// A picture with labels and gestures.
function viewOf(camera, ask) {
	const canvas = make("canvas", "scene");
	const scene = new Scene(canvas, ask);
	const [labels, caption, note] = [make("div", "labels"), make("figcaption"), make("span", "soft")];
	const element = make("figure", "", canvas, labels, caption);
	$("views").append(element);
	let seen;
	const size = () => {
		const [width, height] = [element.clientWidth, element.clientHeight].map((x) => max(1, round(x*min(2, devicePixelRatio))));
		if (canvas.width !== width || canvas.height !== height) assign(canvas, {width, height});
		ask();
	};
	new ResizeObserver(size).observe(element);

	function set(trial, mark) {
		entitled(canvas, `Scene of ${trial.name}`);
		// The head of the page names a single trial.
		caption.replaceChildren(...mark ? [make("b", mark, trial.name)] : [], note);
		labels.replaceChildren(...trial.points.map((name) => make("span", "", name)));
		size();
	}

	function draw(trial, tick, visible) {
		seen = [trial, tick];
		scene.draw(trial, tick, camera, visible);
		trial.points.forEach((_, p) => {
			const at = visible.points && scene.project(trial.point(tick, p));
			labels.children[p].hidden = !at;
			if (at) labels.children[p].style.transform = `translate(${at[0]*element.clientWidth + 9}px, ${at[1]*element.clientHeight - 20 + 15*p}px)`;
		});
		const {long, newtons} = camera.arrow();
		const words = trial.channels.filter((channel) => channel.words).map((channel) => show(channel, channel.values[floor(tick)]));
		note.textContent = [
			words.join(" "),
			trial.has.forces && visible.forces ? `arrow of ${length(long)}: ${short(newtons, "N")}` : "",
			visible.trails ? `trails: ${namesOf(trial.trails)}` : "",
			farsa.ready && tick >= trial.ticks - 1 ? "ended" : "",
		].filter(Boolean).join(" · ");
	}

	function project(p) {
		const place = scene.project(p);
		const box = canvas.getBoundingClientRect();
		return place && {x: box.left + place[0]*box.width, y: box.top + place[1]*box.height};
	}

	steer(canvas, camera, ask, (x, y) => {
		const place = metBy(placedAt(...seen), ...camera.ray(x, y));
		if (place) camera.centre(place);
		ask();
	});
	return {element, canvas, set, draw, project};
}
