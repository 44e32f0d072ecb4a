// Writes the npm package's bunny as an OBJ: node write_obj.cjs OUT
const fs = require("fs");
const { positions, cells } = require("bunny");
fs.writeFileSync(
    process.argv[2],
    positions.map((p) => `v ${p.join(" ")}\n`).join("") + cells.map((c) => `f ${c.map((i) => i + 1).join(" ")}\n`).join(""),
);
