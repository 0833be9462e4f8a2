// One clock for up to two trials.

class Player {
	constructor({trials, view, made_by: maker}) {
		assign(this, {maker, trials, shown: [trials[0]], led: false, clock: trials[0], tick: 0, speed: 1, asked: false, before: 0, views: []});
		this.camera = new Camera(view === "top");
		this.visible = {forces: true, rays: true, points: false, trails: view === "top"};
		this.strips = stripsOf((part) => {
			const {clock} = this;
			this.go(round(clock.tickAt(clock.times[0] + part*(clock.end - clock.times[0]))));
		});
		this.images = imagesOf();
		this.graph = graphOf();
	}

	get now() {
		return this.clock.timeAt(this.tick);
	}

	get ended() {
		return this.tick >= this.clock.ticks - 1;
	}

	// Trials are synchronized by time. A shorter one rests at its end.
	tickOf(trial) {
		return trial === this.clock ? this.tick : trial.tickAt(this.now);
	}

	at(trial) {
		return floor(this.tickOf(trial));
	}

	ask() {
		if (!this.asked) requestAnimationFrame((time) => this.frame(time));
		this.asked = true;
	}

	frame(time) {
		const {clock, shown} = this;
		this.asked = false;
		// Without a trial, or without WebGL 2, nothing is drawn.
		if (!clock || !this.views[0]) return;
		if (farsa.playing) {
			// A page that was hidden continues at its tick.
			const longest = this.film ? 2000 : 100;
			this.tick = clock.tickAt(this.now + min(longest, max(0, time - this.before))/1000*this.speed);
			this.before = time;
			this.ask();
		}
		const {camera} = this;
		camera.carry(this.followedPlace());
		shown.forEach((trial, i) => this.views[i].draw(trial, this.tickOf(trial), this.visible));
		this.film?.take();
		if (farsa.playing && this.ended) this.pause();
		const tick = floor(this.tick);
		$("slider").value = tick;
		const text = clockOf(clock, tick);
		$("slider").setAttribute("aria-valuetext", text.split(" · ")[0]);
		$("clock").textContent = text;
		const part = (this.now - clock.times[0])/(clock.end - clock.times[0] || 1);
		const ticks = shown.map((trial) => this.tickOf(trial));
		this.strips.update(ticks, part, farsa.playing);
		this.images.update(ticks);
		this.graph.update(this.at(shown[0]));
	}

	seek(to) {
		this.tick = min(this.clock.ticks - 1, max(0, +to || 0));
		this.ask();
	}

	play() {
		if (this.ended) this.tick = 0;
		this.before = performance.now();
		farsa.playing = true;
		this.marks();
	}

	// Plays from the start, but not where less motion is preferred.
	replay() {
		this.seek(0);
		if (!matchMedia("(prefers-reduced-motion: reduce)").matches) this.play();
	}

	// Records until the pause or the end of the trial.
	record() {
		if (this.film) return this.pause();
		const {shown, views} = this;
		this.film = filmOf(() => shown.map((_, i) => views[i]), (blob) => {
			farsa.filmed = blob.size;
			save(`${shown[0].name.replace(/[^\w.-]+/g, "-").slice(0, 60)}.webm`, blob);
		});
		this.play();
	}

	pause() {
		this.film?.stop();
		this.film = null;
		// The clock rests on a tick, so that recorded values are shown.
		this.tick = floor(this.tick);
		farsa.playing = false;
		this.marks();
		this.note();
	}

	// The name of the first trial in the address.
	get number() {
		return numbersOf(this.trials)[this.trials.indexOf(this.shown[0])];
	}

	// What the address says of the trial that is shown.
	get address() {
		return {trial: this.number};
	}

	// Shows a trial by the address. Returns false if there is none.
	choose({trial: number}) {
		const trial = this.trials[numbersOf(this.trials).indexOf(number)];
		if (trial && trial !== this.shown[0]) this.show(trial);
		return !!trial;
	}

	// Writes the moment to the address, seldom enough for browsers.
	note() {
		clearTimeout(this.noting);
		this.noting = setTimeout(() => this.write(), 300);
	}

	write() {
		clearTimeout(this.noting);
		// A page within another one may have no address.
		try {
			history.replaceState(null, "", `#${new URLSearchParams({...this.address, t: +this.now.toFixed(4)})}`);
		} catch {}
	}

	// Copies the address of the moment. Without permission it remains in the address bar.
	async link() {
		this.pause();
		this.write();
		const copied = await navigator.clipboard?.writeText(location.href).then(() => true, () => false);
		$("link").textContent = copied ? "Copied" : "In the address";
		setTimeout(() => ($("link").textContent = "Link"), 1500);
	}

	go(to) {
		this.pause();
		this.seek(to);
	}

	step(by) {
		this.go(floor(this.tick) + by);
	}

	setSpeed(to) {
		$("speed").value = this.speed = +to;
	}

	faster(by) {
		this.setSpeed(SPEEDS[SPEEDS.indexOf(this.speed) + by] || this.speed);
	}

	toggle(name) {
		this.visible[name] = !this.visible[name];
		this.marks();
	}

	// Sets a view of `farsa draw`, or `free` for the last one.
	setView(name) {
		if (name in VIEWS) {
			this.camera.name = name;
			this.frameCamera();
		} else this.camera.top = false;
		this.marks();
	}

	followedPlace() {
		const {camera: {followed}, shown: [trial]} = this;
		return followed === null ? null : trial.between(this.tickOf(trial), followed).position;
	}

	// Follows a body by its name, or none for "".
	follow(name) {
		this.led = true;
		this.attend(name);
		if (this.shown[0].travels) this.frameCamera();
	}

	attend(name) {
		const body = this.shown[0].bodies.indexOf(name);
		assign(this.camera, {followed: body < 0 ? null : body, carried: null});
		$("follow").value = body < 0 ? "" : name;
		this.ask();
	}

	// Updates the states of buttons.
	marks() {
		$("play").classList.toggle("playing", farsa.playing);
		entitled($("play"), farsa.playing ? "Pause" : "Play");
		for (const [name, on] of entries({...this.visible, record: !!this.film})) setPressed($(name), on);
		$("camera").value = this.camera.top ? "top" : this.camera.name === "top" ? "overview" : this.camera.name;
		this.ask();
	}

	frameCamera() {
		const {clientWidth: w, clientHeight: h} = this.views[0].element;
		const [trial] = this.shown;
		const thing = trial.shapes.find((shape) => shape.role === "thing");
		// The camera is not fitted to a changed trial, in which bodies may fly away.
		this.camera.frame(this.shown.filter((one) => !one.changed), w/h || 1.6, thing && trial.between(this.tickOf(trial), thing.body).position, this.followedPlace());
		this.ask();
	}

	setTheme(name) {
		root.dataset.theme = name;
		colors = {};
		this.strips.resize();
		this.graph.layout();
		this.ask();
	}

	// Creates views up to a number.
	open(count) {
		while (this.views.length < count) this.views.push(viewOf(this.camera, () => this.ask()));
	}

	show(a, b, steady) {
		this.place(a, b, steady);
		this.fill();
	}

	// Places trials in the views. A steady camera stays.
	place(a, b, steady) {
		this.shown = [...new Set([a, b || a])];
		const {shown} = this;
		const two = shown.length > 1;
		const mark = (i) => (two ? `trial-${i}` : "");
		this.clock = shown.reduce((x, y) => (y.end > x.end ? y : x));
		this.tick = min(this.tick, this.clock.ticks - 1);
		$("app").classList.toggle("two", two);
		this.open(shown.length);
		shown.forEach((trial, i) => this.views[i].set(trial, mark(i)));
		if (this.views[1]) this.views[1].element.hidden = !two;
		$("trial").value = a.index;
		$("beside").value = two ? b.index : "";
		$("slider").max = this.clock.ticks - 1;
		// The slider keeps its width.
		$("clock").style.setProperty("--wide", `${wide("600 14", [clockOf(this.clock, this.clock.ticks - 1)]) + 4}px`);
		$("slider").style.setProperty("--track", `linear-gradient(90deg, ${trackOf(a, this.clock)})`);
		for (const name of ["forces", "rays", "points"]) $(name).hidden = !shown.some((trial) => trial.has[name]);
		$("camera").replaceChildren(...options(Object.keys(VIEWS).filter((name) => name !== "close" || a.balls.some((ball) => ball.thing)).map((name) => [name, name])));
		const moving = [...new Set(a.moving.map((one) => one.name))];
		$("follow").replaceChildren(...options([["", "follow"], ...moving.map((name) => [name, name])]));
		$("follow").hidden = !moving.length;
		this.attend(a.bodies[this.led ? this.camera.followed : a.travels?.body] ?? "");
		$("network").hidden = !a.network;
		if (!steady) this.frameCamera();
		this.marks();
	}

	// Fills strips, images, network and facts.
	fill() {
		const {shown, clock} = this;
		this.images.set(shown);
		this.strips.set(shown, min(...shown.map((l) => l.times[0])), clock.end);
		if (shown[0].network) this.graph.set(shown[0]);
		$("facts").replaceChildren(...shown.map((trial, i) => factsOf(trial, shown[1] ? `trial-${i}` : "")), make("p", "soft", this.maker || ""));
		this.ask();
	}
}

const clockOf = ({times, ticks}, tick) => `${times[tick].toFixed(2)} s · tick ${tick} of ${ticks - 1}`;

// The numbers of trials in the address: those of the run, or their places if two are the same.
function numbersOf(trials) {
	const numbers = trials.map(({name}) => /\btrial (\d+)/.exec(name)?.[1]);
	return numbers.includes(undefined) || new Set(numbers).size < trials.length ? trials.map((_, i) => `${i}`) : numbers;
}

// The colors of the track under the slider, by phase if the trial has them.
function trackOf(trial, clock) {
	const words = trial === clock && trial.channels.find((c) => c.words);
	const percent = (t) => `${100*t/(trial.ticks - 1 || 1)}%`;
	const stops = words ? runs(words.values).map(([from, to, color]) => `${color} ${percent(from)} ${percent(to)}`) : ["var(--line)", "var(--line)"];
	return `${stops}, ${stops.at(-1)}`;
}

function factsOf(trial, mark) {
	return make("div", "", make("h2", mark, trial.name),
		make("dl", "", ...trial.facts.flatMap(([name, text]) => [make("dt", "", name), make("dd", "", text)])),
		make("p", "soft", `Positions within ${length(trial.position_unit/2)}${trial.has.forces ? `, forces within ${short(trial.force_unit/2, "N")}` : ""}. For channels point at their names.`));
}
