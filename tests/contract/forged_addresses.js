// Open each address as a link does, and return the addresses at which the page holds an element
// that only the address can have written.
async (addresses) => {
    const { fromAddress, toAddress } = await import("./explorer/inputs.js");
    const foreign = "a[href*=evil], a[href^='javascript:' i], svg a, img, iframe, object, [onerror], [onload], tspan[style*=bold]";
    // Responses that take a second are computed once: the page draws them like any other.
    const slow = new Map();
    const send = window.fetch;
    window.fetch = async (path, options) => {
        if (!/subsurface|evolution/.test(path)) return send(path, options);
        const kind = `${path} ${JSON.parse(options.body).quantities}`;
        const response = slow.get(kind)?.clone() ?? (await send(path, options));
        if (response.ok) slow.set(kind, response.clone());
        return response;
    };
    const found = [];
    const cases = new Set();
    for (const address of addresses) {
        history.replaceState(null, "", address);
        const shown = toAddress(fromAddress(location.search, location.hash).inputs);
        dispatchEvent(new PopStateEvent("popstate"));
        // A case is drawn to the end once: most members are refused, so that cases repeat.
        while (!cases.has(shown) && document.body.dataset.state === "pending") {
            await new Promise((done) => setTimeout(done, 1));
        }
        cases.add(shown);
        if (document.querySelector(foreign)) found.push(address);
    }
    return { found, cases: cases.size };
}
