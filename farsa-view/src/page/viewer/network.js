// The network: columns of nodes lit by their channels, links colored by sign and as strong as their weight.

// Is called with the chosen node or link.
let graphChosen = () => {};
const LABEL = "12px system-ui, sans-serif";
const signed = (x) => (x < 0 ? "" : "+") + x.toFixed(3);

// The nearest node at a place, if any. Its name counts, too, if the place is on that side by `named`.
function nearestNode(nodes, named, x, y) {
	let [best, found] = [12, null];
	for (const node of nodes) {
		const far = named(node) ? abs(node.y - y)*1.3 : hypot(node.x - x, node.y - y);
		if (far < best) [best, found] = [far, node];
	}
	return found;
}

// The nearest link at a place, if any, with its curve as ten straight pieces.
function nearestLink(links, x, y) {
	let [best, found] = [4, null];
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
		// Among links of similar distance the strongest, which is last.
		if (near < best) [best, found] = [min(4, near + 0.5), link];
	}
	return found;
}

// A node's name if it differs from its label.
const nameOf = ({name, label}) => (name === label ? "" : `${name} `);

// The product of a link's weight and its source's activation.
const productOf = ({weight, direct}, activation) => `${direct ? "direct" : signed(weight)} × ${activation.toFixed(3)} = ${signed(weight*activation)}`;

// The text at the pointer on a node or link.
function titleOf(over, say, valueOf) {
	if (!over) return "";
	return over.links ? `${over.label}: ${say(over)}` : `${over.from.label} → ${over.to.label}: ${productOf(over, valueOf(over.from))}`;
}

const rowOf = (className, ...cells) => make("tr", className, ...cells.map((cell) => make("td", "", cell)));

// The numbers of a node or link. `say` returns a node's present value as text, `valueOf` as a number.
function aboutOf(chosen, links, say, valueOf) {
	if (!chosen) return [make("p", "soft", "Point at a node or a link, or tap it, for its numbers.")];
	if (!chosen.links) {
		const {from, to, weight} = chosen;
		return [make("h3", "", `${from.label} → ${to.label}`, make("b", "", signed(weight))), make("p", "", `weight × activation: ${productOf(chosen, valueOf(from))}`), make("p", "", `source ${nameOf(from)}${say(from)}, target ${nameOf(to)}${say(to)}`)];
	}
	const table = (head, here, there) => {
		const some = links.filter((l) => l[here] === chosen).reverse();
		const rows = some.slice(0, 6).map((l) => rowOf("", l[there].label, signed(l.weight), signed(l.weight*valueOf(l.from))));
		const heads = rows[0] ? [rowOf("soft", "", "weight", "× activation")] : [];
		return make("table", "", make("caption", "", `${head} (${some.length})`), ...heads, ...rows);
	};
	return [
		make("h3", "", chosen.label, make("b", "", say(chosen))), make("p", "", nameOf(chosen), chosen.values.map(([name, x]) => `${name} ${signed(x)}`).join(", ")), make("p", "soft", chosen.about),
		make("div", "tables", table("strongest in", "to", "from"), table("strongest out", "from", "to")),
	];
}

// The Bezier curve of a link. Links within a column bend out, down on one side and up on the other.
function curveOf({from: a, to: b}) {
	const [dx, dy] = [b.x - a.x, b.y - a.y];
	const bend = dx ? 0 : (dy < 0 ? -1 : 1)*(14 + abs(dy)*0.28);
	return a === b ? [a.x, a.y, a.x + 26, a.y - 18, a.x + 26, a.y + 18, a.x, a.y]
		: [a.x, a.y, a.x + dx/3 + bend, a.y + dy/3, b.x - dx/3 + bend, b.y - dy/3, b.x, b.y];
}

// Draws links with an opacity that depends on the relative weight.
function paintLinks(c, links, some, alpha) {
	const strongest = links.reduce((most, {weight, direct}) => (direct ? most : max(most, abs(weight))), 0) || 1;
	for (const {weight, direct, curve: [x, y, ...rest]} of some) {
		const part = direct ? 0.7 : abs(weight)/strongest;
		assign(c, {globalAlpha: alpha(part), lineWidth: 0.5 + (direct ? 1 : 2.4*part), strokeStyle: colorOf(direct ? "--soft" : weight < 0 ? "--a" : "--b")});
		c.beginPath();
		c.moveTo(x, y);
		c.bezierCurveTo(...rest);
		c.stroke();
	}
	c.globalAlpha = 1;
}

// Draws a node in the color of its value.
function paintNode(c, {x, y}, lit, fill) {
	const [ink, soft] = ["--ink", "--soft"].map(colorOf);
	c.beginPath();
	c.arc(x, y, lit ? 7.5 : 6, 0, 7);
	c.fillStyle = fill;
	c.fill();
	assign(c, {lineWidth: lit ? 2.5 : 1, strokeStyle: lit ? ink : soft});
	c.stroke();
}

// Writes a node's name next to it, on the left for the first column.
function paintName(c, {x, y, layer, label: text}, width, ink) {
	text = fitted(c, text, (layer ? width - x : x) - 12);
	assign(c, {lineWidth: 4, strokeStyle: colorOf("--panel"), fillStyle: ink, textAlign: layer ? "left" : "right"});
	for (const way of ["strokeText", "fillText"]) c[way](text, x + (layer ? 11 : -11), y + 0.5);
}

// Writes the number of nodes above a column. `side` chooses by position: first, between, last.
function paintHead(c, column, side) {
	if (!column[0]) return;
	c.textAlign = side("right", "center", "left");
	const canvas = c.canvas.clientWidth;
	const kind = side("sensors", canvas < 400 ? "" : "neurons", "outputs");
	const text = `${column.length} ${column[1] ? kind : kind.slice(0, -1)}`;
	const wide = c.measureText(text).width;
	c.fillText(text, side(max(wide, column[0].x + 6), column[0].x, min(canvas - wide, column[0].x - 6)), max(7, column[0].y - 18));
}

function graphOf() {
	const [canvas, choice] = [$("graph"), $("node")];
	const c = plain(canvas);
	let trial, nodes, links, last, width, ratio, back, tick = 0, over, pinned;
	new ResizeObserver(() => layout()).observe(canvas);
	canvas.onpointermove = (event) => event.pointerType === "mouse" && choose(hit(event), pinned);
	canvas.onpointerleave = () => choose(null, pinned);
	canvas.onclick = (event) => choose(over, hit(event));
	choice.onchange = () => choose(null, nodes[choice.value]);

	function set(other) {
		if (other === trial) return;
		trial = other;
		({nodes, links} = trial.network);
		last = max(...nodes.map((n) => n.layer));
		over = pinned = null;
		choice.replaceChildren(...options([[-1, "node …"], ...nodes.map((n, i) => [i, n.label])]));
		layout();
	}

	function choose(a, b) {
		if (a === over && b === pinned) return;
		[over, pinned] = [a, b];
		graphChosen(nodes[choice.value = nodes.indexOf(pinned)]);
		draw();
		tell();
	}

	const valueOf = (node) => trial.channels[node.channel].values[tick];
	const say = (node) => `${show(trial.channels[node.channel], valueOf(node))} ${trial.channels[node.channel].unit || ""}`;
	const side = (layer, first, middle, end) => (layer ? (layer === last ? end : middle) : first);

	function layout() {
		width = canvas.clientWidth;
		if (!trial || !width) return;
		const columns = list(last + 1, (layer) => nodes.filter((n) => n.layer === layer));
		const height = max(200, max(...columns.map((column) => column.length))*16 + 30);
		ratio = min(2, devicePixelRatio);
		canvas.style.height = `${height}px`;
		assign(canvas, {width: round(width*ratio), height: round(height*ratio)});
		c.font = LABEL;
		const room = (column) => min(width*0.37, max(...column.map((n) => c.measureText(n.label).width))) + 16;
		const left = room(columns[0]);
		const right = last ? width - room(columns[last]) : left;
		columns.forEach((column, layer) => {
			// A short column stays together, so that its links do not cross the whole picture.
			const step = min((height - 30)/column.length, side(layer, 24, 34, 24));
			column.forEach((node, i) => {
				node.x = left + (right - left)*layer/(last || 1);
				node.y = height/2 + 8 + (i - (column.length - 1)/2)*step;
			});
		});
		for (const link of links) link.curve = curveOf(link);
		back = assign(make("canvas"), {width: canvas.width, height: canvas.height});
		const hidden = plain(back);
		hidden.setTransform(ratio, 0, 0, ratio, 0, 0);
		paintLinks(hidden, links, links, (part) => 0.03 + 0.72*part**2.5);
		draw();
		tell();
	}

	function update(now) {
		if (now === tick || !trial) return;
		tick = now;
		draw(), tell();
	}

	function draw() {
		if (!back) return;
		const chosen = over || pinned;
		c.setTransform(1, 0, 0, 1, 0, 0);
		c.clearRect(0, 0, canvas.width, canvas.height);
		c.globalAlpha = chosen ? 0.16 : 1;
		c.drawImage(back, 0, 0);
		c.setTransform(ratio, 0, 0, ratio, 0, 0);
		paintLinks(c, links, chosen ? chosen.links || [chosen] : [], (part) => 0.25 + 0.75*part);
		assign(c, {font: LABEL, textBaseline: "middle"});
		const [ink, soft, panel] = ["--ink", "--soft", "--panel"].map(colorOf);
		for (const node of nodes) {
			const lit = chosen && [chosen, chosen.from, chosen.to].includes(node);
			const value = valueOf(node);
			paintNode(c, node, lit, Number.isNaN(value) ? panel : `rgb(${heatOf(trial.channels[node.channel], value)})`);
			if (side(node.layer, true, lit, true)) paintName(c, node, width, lit || !chosen ? ink : soft);
		}
		c.fillStyle = soft;
		for (let layer = 0; layer <= last; layer++) paintHead(c, nodes.filter((n) => n.layer === layer), (...of) => side(layer, ...of));
	}

	function hit({offsetX: x, offsetY: y}) {
		const named = (node) => side(node.layer, x < node.x, false, x > node.x);
		return nearestNode(nodes, named, x, y) || nearestLink(links, x, y);
	}

	function tell() {
		$("about").replaceChildren(...aboutOf(over || pinned, links, say, valueOf));
		canvas.title = titleOf(over, say, valueOf);
	}

	return {set, layout, update};
}
