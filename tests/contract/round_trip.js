// Scenes of every tab and kind with random values, each with the requests that it makes and
// those that the scene of its address makes.
async (count) => {
    const { defaultScene, fromAddress, TABS, toAddress, withKind } = await import("./explorer/scene.js");
    const { DEFAULT_FIELDS } = await import("./explorer/shapes.js");
    const { QUESTIONS } = await import("./explorer/questions.js");
    const { ask } = await import("./explorer/requests.js");
    const answers = new Map();
    const requestsOf = async (scene) => {
        const made = [];
        const recording = (name, path, body) => {
            const request = JSON.stringify([path, body]);
            made.push(request);
            if (!answers.has(request)) answers.set(request, ask(path, body));
            return answers.get(request);
        };
        let solved = true;
        await QUESTIONS[scene.tab].solve(scene, recording).catch(() => { solved = false; });
        return { made, solved };
    };
    const kinds = Object.keys(DEFAULT_FIELDS);
    const results = [];
    for (let i = 0; i < count; i++) {
        const scene = withKind({ ...defaultScene(), tab: TABS[i % TABS.length] }, kinds[i % kinds.length]);
        for (const [key, value] of Object.entries(scene)) {
            if (typeof value === "number" && !/^nu|exponent|body/.test(key)) scene[key] = value * (0.7 + 0.6 * Math.random());
        }
        if (scene.kind === "tabulated") scene.table.f = scene.table.f.map((f) => f * (1 + Math.random() / 1e4));
        if (Math.random() < 0.3) scene.e2 = "rigid";
        const url = new URL(toAddress(scene), document.baseURI);
        const [first, second] = [await requestsOf(scene), await requestsOf(fromAddress(url.search, url.hash))];
        results.push({ url: url.href, first: first.made, second: second.made, solved: first.solved });
    }
    return results;
}
