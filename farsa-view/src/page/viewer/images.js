// Camera images next to the strips, with square pixels.

function imagesOf() {
	let shown = [];

	function set(trials) {
		shown = trials.flatMap((trial, i) => trial.images.map(({name, columns, rows}, number) => {
			const canvas = assign(make("canvas"), {width: columns, height: rows});
			const note = make("span", "soft");
			const element = make("div", "", canvas, make("p", trials[1] ? `trial-${i}` : "", `${name} `, note));
			element.dataset.name = name;
			return {trial, i, number, canvas, note, element, text: `${columns} × ${rows}`};
		}));
		$("images").hidden = !shown.length;
		$("images").replaceChildren(...shown.map(({element}) => element));
	}

	function update(ticks) {
		for (const image of shown) {
			const {trial, i, number, canvas, note, text} = image;
			const tick = floor(ticks[i]);
			if (image.tick === tick) continue;
			image.tick = tick;
			const colors = trial.image(tick, number);
			const c = plain(canvas);
			c.clearRect(0, 0, canvas.width, canvas.height);
			if (colors) c.putImageData(new ImageData(colors, canvas.width), 0, 0);
			note.textContent = colors ? text : "not recorded";
		}
	}

	return {set, update};
}
