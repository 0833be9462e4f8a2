// The network: columns of nodes lit by their channels, links coloured by sign and as strong as their weight.

const LABEL = "12px system-ui, sans-serif";
const signed = (x) => (x < 0 ? "" : "+") + x.toFixed(3);

function graphOf() {
	const [canvas, choice] = [$("graph"), $("node")];
	const c = canvas.getContext("2d");
	let life, nodes, links, last, width, ratio, back, tick = 0, over, pinned;
	new ResizeObserver(() => layout()).observe(canvas);
	canvas.onpointermove = (event) => event.pointerType === "mouse" && choose(hit(event), pinned);
	canvas.onpointerleave = () => choose(null, pinned);
	canvas.onclick = (event) => choose(over, hit(event));
	choice.onchange = () => choose(null, nodes[choice.value]);

	function set(other) {
		if (other === life) return;
		life = other;
		({nodes, links} = life.network);
		last = max(...nodes.map((n) => n.layer));
		over = pinned = null;
		choice.replaceChildren(...options([[-1, "node …"], ...nodes.map((n, i) => [i, n.name])]));
		layout();
	}

	function choose(a, b) {
		if (a === over && b === pinned) return;
		[over, pinned] = [a, b];
		choice.value = nodes.indexOf(pinned);
		draw();
		tell();
	}

	const valueOf = (node) => life.channels[node.channel].values[tick];
	const say = (node) => `${show(life.channels[node.channel], valueOf(node))} ${life.channels[node.channel].unit || ""}`;
	const side = (layer, first, middle, end) => (layer ? (layer === last ? end : middle) : first);

	function layout() {
		width = canvas.clientWidth;
		if (!life || !width) return;
		const columns = list(last + 1, (layer) => nodes.filter((n) => n.layer === layer));
		const height = max(200, max(...columns.map((column) => column.length))*16 + 30);
		ratio = min(2, devicePixelRatio);
		canvas.style.height = `${height}px`;
		Object.assign(canvas, {width: round(width*ratio), height: round(height*ratio)});
		c.font = LABEL;
		const room = (column) => min(width*0.27, max(...column.map((n) => c.measureText(n.name).width))) + 16;
		const left = room(columns[0]);
		const right = last ? width - room(columns[last]) : left;
		columns.forEach((column, layer) => {
			// A short column stays together, so that its links do not cross all of the picture.
			const step = min((height - 30)/column.length, side(layer, 24, 34, 24));
			column.forEach((node, i) => {
				node.x = left + (right - left)*layer/(last || 1);
				node.y = height/2 + 8 + (i - (column.length - 1)/2)*step;
			});
		});
		for (const link of links) {
			const {from: a, to: b} = link;
			const [dx, dy] = [b.x - a.x, b.y - a.y];
			// Links within a column bend out, down on one side and up on the other.
			const bend = dx ? 0 : (dy < 0 ? -1 : 1)*(14 + abs(dy)*0.28);
			link.curve = a === b ? [a.x, a.y, a.x + 26, a.y - 18, a.x + 26, a.y + 18, a.x, a.y]
				: [a.x, a.y, a.x + dx/3 + bend, a.y + dy/3, b.x - dx/3 + bend, b.y - dy/3, b.x, b.y];
		}
		back = Object.assign(make("canvas"), {width: canvas.width, height: canvas.height});
		paint(back.getContext("2d"), links, (part) => 0.03 + 0.72*part**2.5);
		draw();
		tell();
	}

	function paint(c, some, alpha) {
		c.setTransform(ratio, 0, 0, ratio, 0, 0);
		const strongest = abs(links.at(-1)?.weight) || 1;
		for (const {weight, curve: [x, y, ...rest]} of some) {
			const part = abs(weight)/strongest;
			Object.assign(c, {globalAlpha: alpha(part), lineWidth: 0.5 + 2.4*part, strokeStyle: colorOf(weight < 0 ? "--a" : "--b")});
			c.beginPath();
			c.moveTo(x, y);
			c.bezierCurveTo(...rest);
			c.stroke();
		}
		c.globalAlpha = 1;
	}

	function update(now) {
		if (now === tick || !life) return;
		tick = now;
		draw();
		tell();
	}

	function draw() {
		if (!back) return;
		const chosen = over || pinned;
		c.setTransform(1, 0, 0, 1, 0, 0);
		c.clearRect(0, 0, canvas.width, canvas.height);
		c.globalAlpha = chosen ? 0.16 : 1;
		c.drawImage(back, 0, 0);
		paint(c, chosen ? chosen.links || [chosen] : [], (part) => 0.25 + 0.75*part);
		Object.assign(c, {font: LABEL, textBaseline: "middle"});
		const [ink, soft, panel] = ["--ink", "--soft", "--panel"].map(colorOf);
		for (const node of nodes) {
			const {x, y, layer} = node;
			const lit = chosen && [chosen, chosen.from, chosen.to].includes(node);
			const value = valueOf(node);
			c.beginPath();
			c.arc(x, y, lit ? 7.5 : 6, 0, 7);
			c.fillStyle = Number.isNaN(value) ? panel : `rgb(${heatOf(life.channels[node.channel], value)})`;
			c.fill();
			Object.assign(c, {lineWidth: lit ? 2.5 : 1, strokeStyle: lit ? ink : soft});
			c.stroke();
			if (side(layer, false, !lit, false)) continue;
			let text = node.name;
			while (text.length > 2 && c.measureText(text).width > (layer ? width - x : x) - 12) text = `${text.slice(0, -2)}…`;
			Object.assign(c, {lineWidth: 4, strokeStyle: panel, fillStyle: lit || !chosen ? ink : soft, textAlign: layer ? "left" : "right"});
			for (const way of ["strokeText", "fillText"]) c[way](text, x + (layer ? 11 : -11), y + 0.5);
		}
		c.fillStyle = soft;
		for (let layer = 0; layer <= last; layer++) {
			const column = nodes.filter((n) => n.layer === layer);
			if (!column[0]) continue;
			c.textAlign = side(layer, "right", "center", "left");
			c.fillText(`${column.length} ${side(layer, "sensors", "neurons", "outputs")}`, column[0].x + side(layer, 6, 0, -6), max(7, column[0].y - 18));
		}
	}

	function hit({offsetX: x, offsetY: y}) {
		let [best, found] = [12, null];
		for (const node of nodes) {
			const named = side(node.layer, x < node.x, false, x > node.x);
			const far = named ? abs(node.y - y)*1.3 : hypot(node.x - x, node.y - y);
			if (far < best) [best, found] = [far, node];
		}
		if (found) return found;
		best = 4;
		for (const link of links) {
			const [x0, y0, x1, y1, x2, y2, x3, y3] = link.curve;
			let [near, px, py] = [best, x0, y0];
			for (let t = 0.1; t < 1.01; t += 0.1) {
				const on = (a, b, d, e) => (1 - t)**3*a + 3*t*(1 - t)**2*b + 3*t*t*(1 - t)*d + t**3*e;
				const [ux, uy] = [on(x0, x1, x2, x3) - px, on(y0, y1, y2, y3) - py];
				const s = min(1, max(0, ((x - px)*ux + (y - py)*uy)/(ux*ux + uy*uy || 1)));
				near = min(near, hypot(px + s*ux - x, py + s*uy - y));
				[px, py] = [px + ux, py + uy];
			}
			// Of links about as near the strongest, which comes last.
			if (near < best) [best, found] = [min(4, near + 0.5), link];
		}
		return found;
	}

	function tell() {
		const chosen = over || pinned;
		const table = (head, here, there) => {
			const some = links.filter((l) => l[here] === chosen).reverse();
			const rows = some.slice(0, 6).map((l) => make("tr", "", make("td", "", l[there].name), make("td", "", signed(l.weight))));
			return make("table", "", make("caption", "", `${head} (${some.length})`), ...rows);
		};
		let parts = [make("p", "soft", "Point at a node or a link, or tap it, for its numbers.")];
		if (chosen?.links) {
			parts = [
				make("h3", "", chosen.name, make("b", "", say(chosen))), make("p", "", chosen.values.map(([name, x]) => `${name} ${signed(x)}`).join(", ")),
				make("div", "tables", table("strongest in", "to", "from"), table("strongest out", "from", "to")),
			];
		} else if (chosen) {
			const {from, to, weight} = chosen;
			parts = [make("h3", "", `${from.name} → ${to.name}`, make("b", "", signed(weight))), make("p", "", `source ${say(from)}, target ${say(to)}`)];
		}
		$("about").replaceChildren(...parts);
	}

	return {set, layout, update};
}
