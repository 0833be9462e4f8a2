"use strict";
// The data of the page, docs/replay-format.md. Everything is checked first, so that a cut or changed page shows an error and no
// wrong number.

const {abs, ceil, cos, floor, hypot, log10, max, min, PI, round, sin, sqrt} = Math;
const {assign, entries, fromEntries} = Object;

class Damage extends Error {}
// A browser that lacks what the page needs.
class Unsupported extends Error {}

function need(ok, text) {
	if (!ok) throw new Damage(text);
}

const inside = (ok, what) => need(ok, `${what} is out of range`);
const whole = (x) => Number.isInteger(x) && x >= 0;
const list = (n, make) => Array.from({length: n}, (_, i) => make(i));

// The bytes of base64.
function bytesOf(text) {
	const letters = atob(text);
	const bytes = new Uint8Array(letters.length);
	for (let i = 0; i < letters.length; i++) bytes[i] = letters.charCodeAt(i);
	return bytes;
}

function crc32(bytes) {
	const table = Int32Array.from(list(256, (c) => {
		for (let k = 0; k < 8; k++) c = c & 1 ? (c >>> 1) ^ 0xedb88320 : c >>> 1;
		return c;
	}));
	let crc = ~0;
	for (let i = 0; i < bytes.length; i++) crc = (crc >>> 8) ^ table[(crc ^ bytes[i]) & 255];
	return ~crc >>> 0;
}

const add = (a, b) => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
const mul = (a, s) => [a[0]*s, a[1]*s, a[2]*s];
const sub = (a, b) => add(a, mul(b, -1));
const dot = (a, b) => a[0]*b[0] + a[1]*b[1] + a[2]*b[2];
const cross = (a, b) => [a[1]*b[2] - a[2]*b[1], a[2]*b[0] - a[0]*b[2], a[0]*b[1] - a[1]*b[0]];
const unit = (a) => a.map((x) => x/(hypot(...a) || 1));
// Rotations: x, y, z, w.
const join = (a, b) => [...add(cross(a, b), add(mul(b, a[3]), mul(a, b[3]))), a[3]*b[3] - dot(a, b)];
const turn = (q, v) => add(v, mul(cross(q, add(cross(q, v), mul(v, q[3]))), 2));
const HOME = {position: [0, 0, 0], rotation: [0, 0, 0, 1]};

// Red, green and blue of a pixel.
const shadesOf = (p) => [(p >> 11)/31, (p >> 5 & 63)/63, (p & 31)/31];

// The points of a mesh and three of them for each triangle.
function solidIn({points, triangles}) {
	const [at, corners] = [new Int16Array(bytesOf(points).buffer), [...new Uint16Array(bytesOf(triangles).buffer)]];
	inside(corners.every((i) => 3*i + 2 < at.length), "a mesh");
	return {at, corners};
}

class Trial {
	constructor(json, index) {
		assign(this, json, {index, json, name: String(json.name)});
		const {ticks, bodies, points, blocks} = json;
		const of = `of trial ${index}`;
		need(whole(ticks) && ticks, `there are no ticks ${of}`);
		need([bodies, points, json.pairs, json.position_origin].every(Array.isArray), `a list ${of} is missing`);
		let bytes;
		try {
			bytes = bytesOf(json.data);
		} catch {
			need(false, `the data ${of} is not base64`);
		}
		need(bytes.length === json.bytes, `the data ${of} has ${bytes.length} bytes where ${json.bytes} were written`);
		const crc = crc32(bytes);
		need(crc === json.crc32, `the data ${of} was changed: its crc32 is ${crc}, ${json.crc32} was written`);
		// Every machine with a browser is little-endian, so blocks are read in place.
		const block = (name, size, each) => {
			const from = blocks[name];
			inside(whole(from) && from%4 === 0 && from + size*each <= bytes.length, `block ${name} ${of}`);
			return each === 4 ? new Float32Array(bytes.buffer, from, size) : from/2;
		};
		const words = this.words = new Uint16Array(bytes.buffer, 0, bytes.length >> 1);
		this.signed = new Int16Array(words.buffer, 0, words.length);
		const solids = (json.meshes || []).map(solidIn);
		this.shapes = json.shapes.map((shape) => ({...shape, solid: solids[shape.mesh]}));
		this.times = block("times", ticks, 4);
		this.end = this.times[ticks - 1];
		this.pushes = [];
		this.poses = block("poses", 7*ticks*bodies.length, 2);
		this.marks = block("points", 3*ticks*points.length, 2);
		// The first word of each tick. Ticks differ in length.
		[this.contactStarts, this.rayStarts] = ["contacts", "rays"].map((name) => {
			let word = block(name, 0, 2);
			return list(ticks, () => {
				const here = word;
				word += 1 + 7*words[here];
				inside(word <= words.length, `block ${name} ${of}`);
				return here;
			});
		});
		const first = block("channels", ticks*json.channels.length, 2);
		this.channels = json.channels.map((channel, c) => {
			const {minimum, scale} = channel;
			const values = new Float64Array(ticks);
			let [low, high] = [Infinity, -Infinity];
			for (let t = 0, at = first + c*ticks; t < ticks; t++, at++) {
				const value = values[t] = words[at] === 65535 ? NaN : minimum + scale*words[at];
				if (value < low) low = value;
				if (value > high) high = value;
			}
			const [least, most] = channel.words ? [0, channel.words.length - 1] : channel.range || [1, 0];
			if (least <= most) [low, high] = [least, most];
			else if (low > high) [low, high] = [0, 1];
			return {...channel, values, low, high};
		});
		this.images = (json.images || []).map((image, i) => this.readImage(image, i, json.images.length, block, of));
		this.spots = this.readGround(json.ground_images || [], block, of);
		if (json.network) this.network = this.readNetwork(json.network, block, of);
	}

	// The first word of an image's pixels at each tick, NaN without an image.
	readImage({name, size: [columns, rows]}, i, count, block, of) {
		const {ticks, words} = this;
		const [from, first] = [block("image_starts", 2*ticks*count, 2) + 2*i*ticks, block("pixels", 0, 2)];
		const starts = list(ticks, (t) => {
			const start = words[from + 2*t] + 65536*words[from + 2*t + 1];
			inside(whole(columns) && whole(rows) && columns*rows && (start === 0xffffffff || first + start + columns*rows <= words.length), `image ${name} ${of}`);
			return start === 0xffffffff ? NaN : first + start;
		});
		return {name, columns, rows, starts};
	}

	// The pixels of images on the ground with their changes.
	readGround(images, block, of) {
		const {ticks, words} = this;
		let word = images[0] && block("ground_pixels", 0, 2);
		let pixels = 0;
		need(images.every(({size: [a, b]}) => whole(a*b) && (pixels += a*b) <= 1e6), `the ground ${of} is too large`);
		return images.flatMap(({size: [columns, rows], ground: [x, y, u, v]}) => {
			const [wide, deep] = [(u - x)/columns, (v - y)/rows];
			const shape = {body: -1, role: "area", kind: "cylinder", radius: 0.15*min(abs(wide), abs(deep)), half_length: 0};
			const spots = list(columns*rows, (k) => ({shape, origin: [x + (k%columns + 0.5)*wide, y + (floor(k/columns) + 0.5)*deep, 0.0005], changes: []}));
			for (let t = 0; t < ticks; t++) {
				for (let n = words[word++]; n; n--, word += 2) spots[words[word]].changes.push([t, words[word + 1] && shadesOf(words[word + 1])]);
			}
			inside(word <= words.length, `block ground_pixels ${of}`);
			return spots;
		});
	}

	readNetwork({nodes, links, values, direct = []}, block, of) {
		nodes = nodes.map((node) => {
			const {label, about = ""} = this.channels[node.channel];
			return {...node, label: label || node.name, about, values: [], links: []};
		});
		const size = ([a, b]) => (whole(a) && a <= b && b <= nodes.length ? b - a : NaN);
		let [end, sum] = [0, 0];
		for (const [first, count] of [...links.map((l) => [l.first, size(l.from)*size(l.to)]), ...values.map((v) => [v.first, size(v.nodes)])]) {
			end = max(end, first + count);
			sum += whole(first) ? count : NaN;
		}
		// A forged network must not read more than was written.
		inside(sum <= this.words.length, `the network ${of}`);
		const weights = block("weights", end, 4);
		const made = [];
		const tie = (a, b, more) => {
			const link = {from: nodes[a], to: nodes[b], ...more};
			inside(link.from && link.to, `the network ${of}`);
			made.push(link);
			for (const node of new Set([link.from, link.to])) node.links.push(link);
		};
		for (const {from, to, first} of links) {
			for (let a = from[0], i = first; a < from[1]; a++) {
				for (let b = to[0]; b < to[1]; b++) {
					tie(a, b, {weight: weights[i++]});
				}
			}
		}
		for (const [a, b] of direct) tie(a, b, {weight: 1, direct: true});
		for (const {name, nodes: [a, b], first} of values) {
			for (let n = a; n < b; n++) nodes[n].values.push([name, weights[first + n - a]]);
		}
		return {nodes, links: made.sort((a, b) => abs(a.weight) - abs(b.weight))};
	}

	place(word) {
		return add(this.position_origin, mul(this.words.subarray(word), this.position_unit));
	}

	pose(tick, body) {
		const word = this.poses + 7*(tick*this.bodies.length + body);
		return {position: this.place(word), rotation: unit([...this.signed.subarray(word + 3, word + 7)])};
	}

	// The pose between two ticks. Values are not interpolated.
	between(tick, body) {
		const f = tick%1;
		const a = this.pose(floor(tick), body);
		if (!f) return a;
		const b = this.pose(floor(tick) + 1, body);
		const s = dot(a.rotation, b.rotation) + a.rotation[3]*b.rotation[3] < 0 ? -f : f;
		return {
			position: add(mul(a.position, 1 - f), mul(b.position, f)),
			rotation: unit(a.rotation.map((x, i) => x*(1 - f) + b.rotation[i]*s)),
		};
	}

	point(tick, p) {
		return this.place(this.marks + 3*(floor(tick)*this.points.length + p));
	}

	each(start, read) {
		return list(this.words[start], (i) => read(start + 1 + 7*i));
	}

	// Contacts of pairs, and external pushes.
	contacts(tick) {
		const touching = this.each(this.contactStarts[floor(tick)], (word) =>
			({pair: this.pairs[this.words[word]], point: this.place(word + 1), force: mul(this.signed.subarray(word + 4), this.force_unit)}));
		const pushes = this.pushes.filter(({steps: [first, end]}) => tick >= first && floor(tick) < end).map(({body, point, force}) => {
			const {position, rotation} = this.pose(floor(tick), body);
			return {pair: [this.bodies[body], "outside"], point: add(position, turn(rotation, point)), force};
		});
		return [...touching, ...pushes, ...this.pull ? [this.pull] : []];
	}

	rays(tick) {
		return this.each(this.rayStarts[floor(tick)], (word) => ({from: this.place(word), to: this.place(word + 3), met: this.words[word + 6]}));
	}

	// The image of a camera at a tick as red, green, blue and opacity of each pixel, or null.
	image(tick, i) {
		const {columns, rows, starts} = this.images[i];
		const start = starts[floor(tick)];
		if (Number.isNaN(start)) return null;
		const colors = new Uint8ClampedArray(4*columns*rows);
		this.words.subarray(start, start + columns*rows).forEach((p, k) => colors.set([...mul(shadesOf(p), 255), 255], 4*k));
		return colors;
	}

	tickAt(time) {
		const {times} = this;
		let [a, b] = [0, this.ticks - 1];
		if (time >= this.end) return b;
		while (b - a > 1) {
			const middle = (a + b) >> 1;
			if (times[middle] <= time) a = middle;
			else b = middle;
		}
		return a + max(0, time - times[a])/(times[b] - times[a]);
	}

	timeAt(tick) {
		const time = this.times[floor(tick)];
		return time + tick%1*((this.times[floor(tick) + 1] ?? time) - time);
	}
}

function readPage(element) {
	const text = element?.textContent.trim();
	need(text, "its data is missing");
	let page;
	try {
		page = JSON.parse(text);
	} catch {
		need(false, "its data is cut or changed (not valid JSON)");
	}
	need(page?.format === "farsa-replay", "its data is not of the format farsa-replay");
	need(page.version === 1, `its data is of version ${page.version}, this viewer reads version 1`);
	// Pages of earlier versions call the episodes `lives`.
	const episodes = page.episodes ?? page.lives;
	need(episodes?.length || page.live, "it holds no trial");
	try {
		for (const trial of episodes) if (whole(trial.meshes)) trial.meshes = episodes[trial.meshes].meshes;
		return {...page, trials: episodes.map((trial, i) => new Trial(trial, i))};
	} catch (error) {
		throw error instanceof Damage ? error : new Damage(`its data lacks something (${error.message})`);
	}
}
