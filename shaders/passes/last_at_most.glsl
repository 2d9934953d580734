// The last of the ascending values texels[begin .. end) that is <= unit; the first always is.
uint lastAtMost(usamplerBuffer texels, uint begin, uint end, uint stride, uint unit) {
    uint lo = begin;
    uint hi = end;
    while (hi - lo > 1u) {
        uint middle = (lo + hi) >> 1u;
        if (texelFetch(texels, int(middle * stride)).x <= unit)
            lo = middle;
        else
            hi = middle;
    }
    return lo;
}
