// FNV-1a, 64 bits, in two halves of 32: what recordings end with.
export class Fnv {
    private high = 0xcbf29ce4;
    private low = 0x84222325;

    add(bytes: Uint8Array): void {
        let { high, low } = this;
        for (let i = 0; i < bytes.length; ++i) {
            low = (low ^ bytes[i]) >>> 0;
            // times 2^40 + 0x1b3: the product's low word exactly, by pieces of 16 bits
            const a = (low & 0xffff) * 0x1b3, b = (low >>> 16) * 0x1b3 + (a >>> 16);
            const carry = b / 65536;
            high = (Math.imul(high, 0x1b3) + (low << 8) + Math.floor(carry)) >>> 0;
            low = (((b & 0xffff) << 16) | (a & 0xffff)) >>> 0;
        }
        this.high = high;
        this.low = low;
    }
    get value(): bigint {
        return (BigInt(this.high) << 32n) | BigInt(this.low);
    }
}
