// Give values that are none to the fields of each analysis and profile kind, one after the other,
// and return the cases after which results are shown beside input to which they do not belong.
async ({ tabs, kinds, values }) => {
    const { defaultInputs, toAddress, withKind } = await import("./explorer/inputs.js");
    const body = document.body;
    const rest = async () => {
        while (body.dataset.state === "pending") await new Promise((done) => setTimeout(done, 1));
    };
    const write = (input, text) => {
        input.value = text;
        input.dispatchEvent(new Event("input"));
    };
    // Each value is followed by the one before, so that requests repeat.
    const responses = new Map();
    const send = window.fetch;
    window.fetch = async (path, options) => {
        const request = path + options.body;
        if (!responses.has(request)) responses.set(request, send(path, options));
        return (await responses.get(request)).clone();
    };
    const errors = [];
    addEventListener("error", ({ message }) => errors.push(message));
    const wrong = [];
    const states = {};
    for (const tab of tabs) {
        for (const kind of kinds) {
            // The text of a field is then the number in the URL.
            const units = { ul: "m", ud: "m", uf: "N", up: "Pa", um: "Pa" };
            history.replaceState(null, "", toAddress(withKind({ ...defaultInputs(), tab, ...units }, kind)));
            dispatchEvent(new PopStateEvent("popstate"));
            await rest();
            for (const [i, text] of values.entries()) {
                const fields = [...document.querySelectorAll("#inputs .field[data-key] > label > input")];
                const field = fields[i % fields.length];
                const { key } = field.closest(".field").dataset;
                const before = field.value;
                write(field, text);
                await rest();
                const { state, drawn } = body.dataset;
                states[state] = (states[state] ?? 0) + 1;
                const shown = document.querySelector("#numbers");
                // The address leaves out what has its default.
                const value = new URLSearchParams(drawn.split("#")[0]).get(key) ?? String(withKind(defaultInputs(), kind)[key]);
                const belong = state === "current" && value === (text && String(Number(text)));
                const empty = shown.childElementCount === 0 || !shown.checkVisibility({ visibilityProperty: true });
                const dimmed = [...document.querySelectorAll("#numbers, #charts, #main-numbers")].every(({ inert }) => inert)
                    && getComputedStyle(document.querySelector("#outdated")).display !== "none";
                const named = document.querySelector(".problem:not(:empty), #problem:not([hidden])");
                if (!belong && !((empty || dimmed) && named)) wrong.push({ tab, kind, key, text, state });
                write(field, before);
            }
            await rest();
        }
    }
    return { wrong, errors, states };
}
