// Channels over time: bands for words, lines for small groups, heat maps for large ones.

const CIVIDIS = ["#00224e", "#35456c", "#666970", "#948e77", "#c8b866", "#fee838"];
const DIVERGING = ["#6db5f2", "#2e5f8d", "#20262e", "#94591f", "#f5a04c"];
const WORDS = ["#56b4e9", "#e69f00", "#009e73", "#cc79a7", "#f0e442", "#0072b2", "#d55e00", "#999999"];

// Values of both signs differ in color, others in brightness. Returns 0..255.
function heatOf({low, high}, value) {
	// A constant is compared with 0.
	if (low === high) [low, high] = [min(0, low), max(0, high)];
	const both = low < 0 && high > 0;
	const stops = both ? DIVERGING : CIVIDIS;
	const u = both ? 0.5 + value/2/max(-low, high) : (value - low)/(high - low || 1);
	const x = min(1, max(0, u))*(stops.length - 1);
	const i = min(floor(x), stops.length - 2);
	const [a, b] = [rgb(stops[i]), rgb(stops[i + 1])];
	return a.map((c, k) => round(255*(c + (b[k] - c)*(x - i))));
}

function show({words, low, high, whole}, value) {
	if (words || Number.isNaN(value)) return words?.[value] ?? "–";
	if (whole) return value.toFixed(0);
	// A nearly constant value has no more digits than others.
	const span = max(high - low, 1e-3*max(abs(low), abs(high))) || 1;
	const text = value.toFixed(min(6, max(0, ceil(2.5 - log10(span)))));
	return +text ? text : text.replace("-", "");
}

// An end of a scale with the digits that its span requires.
const bound = (x, span) => +x.toFixed(min(9, max(0, ceil(2 - log10(max(span, 1e-3*abs(x)))))));

// The scale of values from `low` to `high`, large enough to hide rounding, with constant values in its middle.
function scaleOf(low, high) {
	const room = max(1e-4*max(abs(low), abs(high)), 1e-9) - (high - low);
	return room > 0 ? [low - room/2, high + room/2] : [low, high];
}

// Runs of equal values: [first tick, tick after, color, value].
function runs(values) {
	const found = [];
	values.forEach((value, t) => {
		if (t && value === values[t - 1]) found.at(-1)[1] = t + 1;
		else found.push([t, t + 1, WORDS[value%WORDS.length] || "#999999", value]);
	});
	return found;
}

function make(tag, className = "", ...children) {
	const made = assign(document.createElement(tag), {className});
	made.append(...children);
	return made;
}

// A context that draws at once. Others would queue with the scene where it is drawn without a graphics processor.
const plain = (canvas) => canvas.getContext("2d", {willReadFrequently: true});

// A text without its middle if it is too long.
function fitted(c, text, room) {
	let short = text;
	for (let kept = text.length - 1; kept > 3 && c.measureText(short).width > room; kept--) short = `${text.slice(0, (kept + 1) >> 1)}…${text.slice(-(kept >> 1))}`;
	return short;
}

// Painters of a strip. `x` is the place of a tick, `tall` and `top` are the height and the top of the trial's part, all in pixels.
// `ratio` is the number of pixels per CSS pixel.
function paintBands(c, {values}, {words}, {x, tall, top, ratio}) {
	assign(c, {font: `600 ${12*ratio}px system-ui, sans-serif`, textBaseline: "middle"});
	for (const [t, after, color, value] of runs(values)) {
		const wide = x(min(after, values.length - 1)) - x(t);
		c.fillStyle = color;
		c.fillRect(x(t), top, max(wide, 1), tall - ratio/2);
		c.fillStyle = "#10161c";
		const word = words[value] ?? "";
		if (c.measureText(word).width + 12*ratio < wide) c.fillText(word, x(t) + 6*ratio, top + tall/2);
	}
}

function paintHeat(c, {values}, {low, high}, {x, tall, top, ratio, width}) {
	const span = high - low || 1;
	const image = new ImageData(values.length, 1);
	const table = list(256, (k) => [...heatOf({low, high}, low + span*k/255), 255]);
	values.forEach((value, t) => image.data.set(table[min(255, max(0, round((value - low)/span*255)))] || [], 4*t));
	const line = assign(make("canvas"), {width: values.length, height: 1});
	plain(line).putImageData(image, 0, 0);
	c.imageSmoothingEnabled = values.length > width;
	c.drawImage(line, x(0), top, x(values.length - 1) - x(0) + 1, tall - ratio/2);
}

function paintLine(c, {values}, {low, high}, {x, ratio, width, height, color}) {
	const y = (value) => 3*ratio + (high - value)/(high - low || 1)*(height - 6*ratio);
	c.fillStyle = colorOf("--line");
	if (low < 0 && high > 0) c.fillRect(0, round(y(0)), width, ratio);
	assign(c, {strokeStyle: colorOf(color), lineWidth: 1.5*ratio, lineJoin: "round"});
	c.beginPath();
	// Missing values interrupt the line.
	values.forEach((value, t) => c[Number.isNaN(values[t - 1] ?? NaN) ? "moveTo" : "lineTo"](x(t), y(value)));
	c.stroke();
}

// Draws a row's strip between two times, unless it is current.
function paintStrip(row, trials, from, to) {
	const {canvas, channels, kind, scale} = row;
	const ratio = min(2, devicePixelRatio);
	const [width, height] = [canvas.clientWidth, canvas.clientHeight].map((x) => round(x*ratio));
	const painted = `${width} ${height} ${theme()}`;
	if (row.painted === painted || !width) return;
	row.painted = painted;
	assign(canvas, {width, height});
	const c = plain(canvas);
	const shown = channels.filter(Boolean);
	channels.forEach((channel, i) => {
		if (!channel) return;
		const {times, end} = trials[i];
		const at = (time) => (time - from)/(to - from || 1)*width;
		const x = (t) => at(times[0]) + (at(end) - at(times[0]))*t/max(1, channel.values.length - 1);
		// Lines of two trials share the field, bands and heat maps do not.
		const tall = height/shown.length;
		const place = {x, tall, top: shown.indexOf(channel)*tall, ratio, width, height, color: i ? "--b" : "--a"};
		({bands: paintBands, heat: paintHeat, lines: paintLine})[kind](c, channel, scale, place);
	});
}

// Seeks by dragging along the strips, whose place is `box`.
function dragOn(element, box, seek) {
	let dragged = false;
	const move = ({clientX}) => {
		const {left, width} = box() || {};
		if (dragged && width) seek((clientX - left)/width);
	};
	element.onpointerdown = (event) => {
		dragged = !event.button && event.target.matches(".plot");
		if (dragged) element.setPointerCapture(event.pointerId);
		move(event);
	};
	element.onpointermove = move;
	element.onpointerup = element.onpointercancel = () => (dragged = false);
}

// The legend of a group's bands.
function legendOf(trials, group) {
	const words = trials.flatMap((trial) => trial.channels).find((channel) => channel.group === group && channel.words)?.words || [];
	return words.map((word, i) => {
		const square = make("i");
		square.style.background = WORDS[i%WORDS.length];
		return make("span", "key", square, word);
	});
}

const ruler = document.createElement("canvas").getContext("2d");

// The width of the widest text of a size.
function wide(size, texts) {
	ruler.font = `${size}px system-ui, sans-serif`;
	return ceil(max(...texts.map((text) => ruler.measureText(text).width)));
}

function stripsOf(seek) {
	const [groups, closed] = [$("groups"), new Set()];
	let rows = [], trials = [], from = 0, to = 1, ticks, part;
	const watch = new IntersectionObserver((entries) => {
		for (const {target, isIntersecting} of entries) {
			target.row.near = isIntersecting;
			if (isIntersecting) paintStrip(target.row, trials, from, to);
		}
	}, {rootMargin: "300px"});
	const box = () => rows.find(({canvas}) => canvas.offsetWidth)?.canvas.getBoundingClientRect();
	dragOn(groups, box, seek);
	new ResizeObserver(() => resize()).observe(groups);

	function set(some, first, last) {
		[trials, from, to, rows] = [some, first, last, []];
		watch.disconnect();
		const names = new Map();
		for (const {group, name, label} of trials.flatMap((trial) => trial.channels)) names.set(group, (names.get(group) || new Map()).set(name, label || name));
		groups.replaceChildren(...[...names].map(([group, some]) => section(group, [...some])));
		// As wide as the longest name, within reason.
		groups.style.setProperty("--n", `${min(210, max(80, wide(13, rows.map(({label}) => label)))) + 4}px`);
		resize();
	}

	function section(group, names) {
		// A common prefix of all names, such as "force on sphere.", is omitted.
		let cut = 0;
		while (names[1] && names.every(([, label]) => label[cut] && label[cut] === names[0][1][cut])) cut++;
		const body = make("div", "rows", ...names.map(([name, label]) => row(group, name, label.slice(cut > 7 ? cut : 0), names.length > 11 ? "heat" : "lines")));
		const fold = make("button", "fold", make("b", "", group), make("span", "soft", names.length), ...legendOf(trials, group));
		const made = make("section", "", fold, body);
		// Columns of a narrow page are as wide as their content.
		const own = rows.slice(-names.length);
		const values = own.flatMap(({scale}) => scale.words || [scale.low, scale.high].map((end) => show(scale, end)));
		const columns = {w: trials.length*(wide(13, values) + 14) - 14, u: wide(12, own.map(({unit}) => unit)), s: min(122, wide(12, own.map(({told}) => told)))};
		for (const [name, width] of entries(columns)) made.style.setProperty(`--${name}`, `${width}px`);
		made.dataset.group = group;
		const folded = () => {
			body.hidden = closed.has(group);
			fold.setAttribute("aria-expanded", !body.hidden);
		};
		fold.onclick = () => {
			if (!closed.delete(group)) closed.add(group);
			folded();
			update();
		};
		folded();
		return made;
	}

	function row(group, name, label, mode) {
		const channels = trials.map((trial) => trial.channels.find((c) => c.name === name && c.group === group));
		const some = channels.filter(Boolean);
		const {words, unit = "", scale, about = ""} = some[0];
		// One scale for both trials.
		const ends = [min(...some.map((c) => c.low)), max(...some.map((c) => c.high))];
		const [low, high] = scaleOf(...ends);
		const whole = some.every((c) => c.scale === 1 && Number.isInteger(c.minimum));
		const told = words ? "" : [...new Set(ends.map((end) => bound(end, high - low)))].join(" … ");
		const kind = words ? "bands" : mode;
		const values = channels.map((_, i) => make("span", `value trial-${i}`));
		const canvas = make("canvas", "plot");
		const title = make("span", "name", label);
		const element = make("div", `row ${kind}`, title, make("span", "values", ...values), make("span", "unit", unit), canvas, make("span", "unit", told));
		element.dataset.name = name;
		element.title = `${group} ${name}${words || whole ? "" : ` within ${(scale/2).toPrecision(2)} ${unit}`}${about && `: ${about}`}`;
		const row = element.row = {canvas, channels, kind, values, title, label, unit, told, scale: {words, low, high, whole}};
		rows.push(row);
		watch.observe(element);
		return element;
	}

	function resize() {
		wide(13, []);
		const rooms = rows.map(({title}) => title.clientWidth);
		rows.forEach(({title, label}, i) => {
			const text = rooms[i] ? fitted(ruler, label, rooms[i]) : label;
			if (title.textContent !== text) title.textContent = text;
			title.title = text === label ? "" : label;
		});
		for (const row of rows) if (row.near) paintStrip(row, trials, from, to);
		update();
	}

	function update(now = ticks, share = part, playing = false) {
		[ticks, part] = [now, share];
		if (ticks?.length !== trials.length) return;
		for (const {near, channels, values, scale} of rows) {
			if (near || !playing) channels.forEach((channel, i) => channel && (values[i].textContent = show(scale, channel.values[floor(ticks[i])])));
		}
		const {left, width} = box() || {};
		$("cursor").hidden = !width;
		$("cursor").style.transform = `translateX(${left - $("list").getBoundingClientRect().left + part*width}px)`;
	}

	return {set, resize, update};
}
