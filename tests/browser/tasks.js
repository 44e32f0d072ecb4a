// What holds a page up, from Chromium's own record of it.

// Events within which script runs.
const SCRIPT = new Set(["EvaluateScript", "v8.compile", "v8.compileModule", "v8.evaluateModule", "v8.callFunction", "FunctionCall",
    "TimerFire", "FireAnimationFrame", "RunMicrotasks"]);

/// Runs `work` and returns the longest tasks of the page's own thread meanwhile, in milliseconds: of the clock; of the
/// processor, which other programs do not lengthen; and of the processor in script alone.
export async function longestTasks(browser, page, work) {
    await browser.startTracing(page, { categories: ["toplevel", "devtools.timeline", "v8"] });
    await work();
    const { traceEvents: events } = JSON.parse((await browser.stopTracing()).toString());
    const parsing = events.filter(({ name }) => name === "ParseHTML").reduce((a, b) => (b.dur ?? 0) > (a?.dur ?? -1) ? b : a, null);
    const own = events.filter(({ ph, pid, tid }) => ph === "X" && pid === parsing.pid && tid === parsing.tid).sort((a, b) => a.ts - b.ts || b.dur - a.dur);
    let clock = 0, processor = 0, script = 0, task = null, inScript = 0, end = -1;
    const close = () => {
        if (!task) return;
        clock = Math.max(clock, task.dur);
        processor = Math.max(processor, task.tdur ?? 0);
        script = Math.max(script, inScript);
    };
    for (const event of own) {
        const ends = event.ts + event.dur;
        if (!task || event.ts >= task.ts + task.dur) {  // the outermost
            close();
            task = event;
            inScript = 0;
        }
        if (SCRIPT.has(event.name) && event.ts >= end) {
            inScript += event.tdur ?? 0;
            end = ends;
        }
    }
    close();
    return { clock: clock / 1000, processor: processor / 1000, script: script / 1000 };
}
