// The colours of |μ|.

const viridis = [0x440154, 0x481a6c, 0x472f7d, 0x414487, 0x39568c, 0x31688e, 0x2a788e, 0x23888e, 0x1f988b, 0x22a884,
                 0x35b779, 0x54c568, 0x7ad151, 0xa5db36, 0xd2e21b, 0xfde725];

export function viridisAt(x) {  // 0…1 → [r, g, b]
    const at = Math.min(Math.max(x, 0), 1) * 15, i = Math.min(Math.floor(at), 14), f = at - i;
    const mix = shift => (1 - f) * (viridis[i] >> shift & 255) + f * (viridis[i + 1] >> shift & 255);
    return [16, 8, 0].map(shift => Math.round(mix(shift)));
}
