"""How many samples `tools/bench/peers` takes: powers of four, because stratified and low-discrepancy points want them, up to
where the error aimed at is reached if time allows."""

import math

TARGET = 0.05  # relative RMSE
MARGIN = 1.5  # a pilot that missed its rare bright samples foresees too little
LEAST, MOST = 64, 65536  # samples a pixel at the last level
REFERENCE_LEAST, REFERENCE_MOST = 16, 4096


def levels(top, count):
    """Samples a pixel, each four times those before."""
    return [max(1, top >> 2 * back) for back in reversed(range(count))]


def reaching(error, spp):
    """The power of four at which an error that falls with the root of samples is the target or less."""
    needed = MARGIN * spp * (max(error, 0.0) / TARGET) ** 2
    power = 4 ** math.ceil(math.log(max(needed, 1.0), 4) - 1e-9)
    return min(MOST, max(LEAST, power))


def plan(costs, errors, spp, seconds, count):
    """The last level of each variant, from seconds a sample and the errors at `spp`; the dearest give way until a round
    takes no longer than `seconds`."""
    tops = {name: reaching(errors[name], spp) for name in costs}
    def spent(name):
        return costs[name] * sum(levels(tops[name], count))
    while sum(map(spent, tops)) > seconds:
        shrinking = [name for name in tops if tops[name] > LEAST]
        if not shrinking:
            break
        tops[max(shrinking, key=spent)] //= 4
    return tops


def reference_samples(cost, seconds, replicates, base=4):
    """The most, of powers of `base`, for one of as many images as take so long."""
    wanted = max(1.0, seconds / (cost * replicates))
    return min(REFERENCE_MOST, max(REFERENCE_LEAST, base ** math.floor(math.log(wanted, base) + 1e-9)))
