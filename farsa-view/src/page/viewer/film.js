// Records the views as a video file.

function filmOf(views, done) {
	const canvas = make("canvas");
	const c = canvas.getContext("2d");
	const parts = [];
	let recorder;

	// Copies the views side by side, which must have been drawn in this frame. The first frame begins the film.
	function take() {
		const shown = views().map((view) => view.canvas);
		const [width, height] = [shown.reduce((sum, one) => sum + one.width, 0), max(...shown.map((one) => one.height))];
		// Codecs require even sides, which stay constant.
		if (!recorder) assign(canvas, {width: width & ~1, height: height & ~1});
		let left = 0;
		for (const one of shown) {
			c.drawImage(one, left, 0);
			left += one.width;
		}
		if (!recorder) start();
	}

	function start() {
		recorder = new MediaRecorder(canvas.captureStream(30), {videoBitsPerSecond: 8e6});
		recorder.ondataavailable = (event) => parts.push(event.data);
		recorder.onstop = () => done(new Blob(parts, {type: recorder.mimeType}));
		recorder.start(100);
	}

	// Stops when a frame was encoded, but after three seconds at the latest.
	function stop(tries = 30) {
		if (!recorder) return;
		if (tries && !parts.some(({size}) => size)) setTimeout(stop, 100, tries - 1);
		else recorder.stop();
	}

	return {take, stop: () => setTimeout(stop, 100)};
}

// Saves a file.
function save(name, blob) {
	const link = assign(make("a"), {href: URL.createObjectURL(blob), download: name});
	link.click();
	setTimeout(() => URL.revokeObjectURL(link.href), 1000);
}
