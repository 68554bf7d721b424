// Inputs of every tab and kind with random values, each with the requests that they make and
// those that the inputs of their address make.
async (count) => {
    const { defaultInputs, fromAddress, TABS, toAddress, withKind } = await import("./explorer/inputs.js");
    const { KINDS } = await import("./explorer/shapes.js");
    const { ANALYSES } = await import("./explorer/analyses.js");
    const { query } = await import("./explorer/requests.js");
    const responses = new Map();
    const requestsOf = async (inputs) => {
        const made = [];
        const recording = (name, path, body) => {
            const request = JSON.stringify([path, body]);
            made.push(request);
            if (!responses.has(request)) responses.set(request, query(path, body));
            return responses.get(request);
        };
        let solved = true;
        await ANALYSES[inputs.tab].solve(inputs, recording).catch(() => { solved = false; });
        return { made, solved };
    };
    const kinds = Object.keys(KINDS);
    const results = [];
    for (let i = 0; i < count; i++) {
        const inputs = withKind({ ...defaultInputs(), tab: TABS[i % TABS.length] }, kinds[i % kinds.length]);
        for (const [key, value] of Object.entries(inputs)) {
            if (typeof value === "number" && !/^nu|exponent|body/.test(key)) inputs[key] = value * (0.7 + 0.6 * Math.random());
        }
        // The moduli are those of no material, whose density would tell the mass of a ball.
        inputs.mass = 0.03 * (0.7 + 0.6 * Math.random());
        if (inputs.kind === "tabulated") inputs.table.f = inputs.table.f.map((f) => f * (1 + Math.random() / 1e4));
        if (Math.random() < 0.3) inputs.e2 = "rigid";
        if (Math.random() < 0.3) Object.assign(inputs, { thickness: 1e-3, base: "frictionless" });
        const url = new URL(toAddress(inputs), document.baseURI);
        const [first, second] = [await requestsOf(inputs), await requestsOf(fromAddress(url.search, url.hash).inputs)];
        results.push({ url: url.href, first: first.made, second: second.made, solved: first.solved });
    }
    return results;
}
