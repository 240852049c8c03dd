"""First intersection of rays with F(x,y,z) = C, decided with Arb balls.

    python oracle.py [--cap SECONDS] [--out DIR] [scene ...]

For every scene of scenes.toml writes DIR/<scene>.csv (one row per ray) and
DIR/<scene>.aux.csv (the rays that are neither hit nor miss, with reasons).

The ray is p(t) = o + t*d with o, d, t0, t1 the doubles of the row taken as exact
reals. Front to back over [t0, t1]:
  * an interval is dismissed if an enclosure of F-C over it excludes 0: the ball
    value, the mean value form, or the extended-interval union (extended.py);
  * F-C strictly monotone on it (derivative ball excludes 0): the signs at its ends
    decide; a sign change is a simple root, refined by interval Newton;
  * otherwise it is split. What is left at relative width 1e-12 is retried at 256
    bits, then classified.
Statuses
  hit        t lies within 1e-14 (relative) of the first root, existence proven: a
             simple root, or a proven sign change of a function proven continuous there
             (odd multiplicity, infinite slope: then no normal is given);
  miss       no root in [t0, t1];
  touch      F is continuous there, no sign change is proven, 0 cannot be excluded:
             an even-multiplicity root or a plateau starting at t; (t0,t) has no root;
  undecided  0 cannot be excluded next to a jump, pole, 0/0 or domain edge, or the
             root is at the clipped end of the segment, or the work limit was reached;
             t (if given) is where: (t0,t) has no root.
"""
import argparse
import csv
import math
import pathlib
import sys
import time
import tomllib
from flint import arb, arb_poly, ctx
from expr import Program, JUMP
from extended import enclose

DATA = pathlib.Path(__file__).resolve().parents[2] / "testdata" / "oracle"
PREC, HIGH_PREC = 128, 256
LEAF = 1e-12            # relative width at which an interval is classified
FINE = 2e-15            # the same inside a proven sign change
END = 1e-12             # roots this close to t0 or t1 are `undecided`
SPLIT = 0.4883          # off centre, so that symmetric scenes have no root at a split
MAX_EVALS = 20000       # per ray
MAX_LEAVES = 24         # unresolved leaves per ray, after which the scan stops
JOIN = 6                # unresolved leaves in a row kept back before they are a `touch`
POLY_AFTER = 60         # evaluations after which a polynomial is also Taylor-shifted
POLY_DEGREE = 40
ZERO, ONE = arb(0), arb(1)


class Surface:
    def __init__(self, formula, level):
        self.prog = Program(formula, level)
        if self.prog.const[self.prog.root] is not None:
            c = self.prog.const[self.prog.root]
            self.dual, self.value = (lambda *a: (c, ZERO)), (lambda *a: c)
        else:
            self.dual, self.value = self.prog.compile(True), self.prog.compile(False)
        deg = self.prog.degree()
        self.is_poly = deg is not None and 0 < deg <= POLY_DEGREE


class Event:
    """A place where the scan could not pass, or the hit that ends it."""
    def __init__(self, status, lo, hi, reason="", t=None):
        self.status, self.lo, self.hi, self.reason = status, lo, hi, reason
        self.t = t              # Arb enclosure of the root, for a hit


class Tracer:
    """The search along one ray."""

    def __init__(self, surface, origin, direction):
        self.s = surface
        self.o = [arb(v) for v in origin]
        self.d = [arb(v) for v in direction]
        self.signs, self.evals = {}, 0
        self.poly = self.base = None            # F-C as a polynomial in t - base

    def point(self, t):
        return [o + d * t for o, d in zip(self.o, self.d)]

    @staticmethod
    def ball(a, b):
        m = 0.5 * (a + b)
        return arb(m, math.nextafter(max(b - m, m - a), math.inf)), arb(m)

    def sign(self, t):
        """Sign of F-C at the double t: 1, -1, 0 (proven zero) or None."""
        if t not in self.signs:
            r = None
            for prec in (PREC, HIGH_PREC, 4 * HIGH_PREC):
                ctx.prec = prec
                JUMP[0] = False
                self.evals += 1
                v = self.s.value(*self.point(arb(t)))
                ok = v.is_finite() and not JUMP[0]
                r = (1 if v > 0 else -1 if v < 0 else 0 if v.is_zero() else None) if ok else None
                if r is not None:
                    break
            ctx.prec = PREC
            self.signs[t] = r
        return self.signs[t]

    def extended(self, a, b):
        """Extended-interval union of F-C over [a,b] -> (pieces, continuous)."""
        ta, tb, box = arb(a), arb(b), []
        for o, k in zip(self.o, self.d):
            p, q = o + k * ta, o + k * tb
            box.append((p.lower(), q.upper()) if k >= 0 else (q.lower(), p.upper()))
        pieces, cont = enclose(self.s.prog, box)
        self.evals += 10 * len(pieces)
        return pieces, cont

    def examine(self, a, b):
        """-> ("none" | "root" | "split", continuous, reason)"""
        T, m = self.ball(a, b)
        JUMP[0] = False
        self.evals += 1
        v, d = self.s.dual(*self.point(T), *self.d)
        if not v.is_finite() or JUMP[0]:
            why = "jump" if JUMP[0] else "pole or domain edge"
            pieces, cont = self.extended(a, b)
            if all(lo > 0 or hi < 0 for lo, hi in pieces):
                return "none", cont, why
            return "split", cont, why
        if v > 0 or v < 0:
            return "none", True, ""
        if v.is_zero():
            return "split", True, "plateau: F = C exactly"
        if not d.is_finite():
            return "split", True, "no derivative"
        if d > 0 or d < 0:
            sa, sb = self.sign(a), self.sign(b)
            if sa and sb:
                return ("none" if sa == sb else "root"), True, ""
        mv = self.s.value(*self.point(m)) + d * (T - m)
        if mv > 0 or mv < 0:
            return "none", True, ""
        if self.s.is_poly and self.evals > POLY_AFTER:
            return self.examine_poly(a, b), True, ""
        return "split", True, ""

    def examine_poly(self, a, b):
        """The same question put to the Taylor coefficients at the middle of [a,b]."""
        old, ctx.prec = ctx.prec, HIGH_PREC
        try:
            if self.poly is None:
                self.base = a
                self.poly = self.s.value(*(arb_poly([o + d * arb(a), d])
                                           for o, d in zip(self.o, self.d)))
            lo, hi = arb(a), arb(b)
            self.evals += 1
            c = self.poly(arb_poly([(lo + hi) / 2 - self.base, (hi - lo) / 2])).coeffs()
            size = [k.abs_upper() for k in c]
            if not c or c[0].abs_lower() > sum(size[1:], ZERO):
                return "none" if c else "split"
            if len(c) > 1 and c[1].abs_lower() > sum((k * v for k, v in enumerate(size) if k > 1), ZERO):
                sa, sb = self.sign(a), self.sign(b)
                if sa and sb:
                    return "none" if sa == sb else "root"
            return "split"
        finally:
            ctx.prec = old

    def newton(self, a, b, tol=1e-27):
        """Enclosure of the single root of a function monotone on [a,b]."""
        lo, hi, slo = arb(a), arb(b), self.sign(a)
        for _ in range(400):
            width = hi - lo
            if width < tol * max(abs(a), abs(b), 1e-300):
                break
            m = ((lo + hi) / 2).mid()
            X = lo.union(hi)
            v = self.s.value(*self.point(m))
            d = self.s.dual(*self.point(X), *self.d)[1]
            if d > 0 or d < 0:
                N = m - v / d
                lo = lo if not N.lower() > lo else N.lower()
                hi = hi if not N.upper() < hi else N.upper()
            if not hi - lo < width / 2:
                if v > 0 or v < 0:
                    if (1 if v > 0 else -1) == slo:
                        lo = m if m > lo else lo
                    else:
                        hi = m if m < hi else hi
                else:
                    break
        return lo.union(hi)

    def leaf(self, a, b):
        """examine at high precision, with the extended intervals as a second opinion."""
        ctx.prec = HIGH_PREC
        verdict, cont, why = self.examine(a, b)
        if verdict == "split":
            pieces, ok = self.extended(a, b)
            if all(lo > 0 or hi < 0 for lo, hi in pieces):
                verdict = "none"
            cont = cont or ok
        ctx.prec = PREC
        return verdict, cont, why

    def scan(self, t0, t1):
        """Events from t0 on: unresolved places, up to and including the first hit."""
        scale = max(abs(t0), abs(t1))
        leaf, fine = LEAF * scale, FINE * scale
        events, leaves = [], 0
        held = None             # [lo, hi, why, n]: unresolved leaves in a row, F continuous
        bracket_end = None      # while inside a proven sign change

        def record(status, lo, hi, why):
            nonlocal leaves
            leaves += 1
            last = events[-1] if events else None
            if last and last.hi >= lo - JOIN * leaf and "undecided" in (last.status, status):
                reason = why if status == "undecided" else last.reason
                last.status, last.hi, last.reason = "undecided", hi, reason
            elif last and last.status == status and last.hi >= lo:
                last.hi = hi
            else:
                events.append(Event(status, lo, hi, why))

        def flush():
            nonlocal held
            if held:
                if bracket_end is None:
                    record("touch", held[0], held[1], held[2] or "zero not excluded, no sign change")
                else:           # a root is proven here, but not placed to 1e-14
                    record("undecided", held[0], bracket_end, "root located coarsely")
                held = None

        stack = [(t0, t1)]
        while stack:
            a, b = stack.pop()
            if bracket_end is not None and a >= bracket_end:
                flush()
                bracket_end = None
            if self.evals > MAX_EVALS:
                flush()
                events.append(Event("undecided", a, b, "work limit"))
                return events
            verdict, cont, why = self.examine(a, b)
            w = b - a
            inside = bracket_end is not None
            if verdict == "split":
                m = a + SPLIT * w
                if w > (fine if inside else leaf) and a < m < b:
                    stack += [(m, b), (a, m)]
                    continue
                verdict, cont, why = self.leaf(a, b)
            if verdict == "none":
                if not inside:
                    flush()
                continue
            if held and held[1] < a:
                flush()
            if verdict == "root" and not held:
                T = self.newton(a, b)
                if not T.rad() < 5e-15 * scale:
                    ctx.prec = 4 * HIGH_PREC
                    T = self.newton(a, b)
                    ctx.prec = PREC
                ok = T.rad() < 5e-15 * scale
                events.append(Event("hit" if ok else "undecided", a, b,
                                    "simple" if ok else "root located coarsely", T))
                return events
            # an unresolved leaf, or a root right behind unresolved leaves
            if not cont:
                record("undecided", held[0] if held else a, b, why)
                held = None
            else:
                start = held[0] if held else a
                ss, sb = self.sign(start), self.sign(b)
                if ss and sb and ss != sb:
                    if b - start <= 1e-14 * scale:
                        events.append(Event("hit", start, b, "sign change, not a proven simple root",
                                            arb(start).union(arb(b))))
                        return events
                    if not inside:
                        held, bracket_end = None, b
                        m = start + SPLIT * (b - start)
                        stack += [(m, b), (start, m)]
                        continue
                why = why or ("exact zero at a double" if ss == 0 else "")
                held = [start, b, held[2] if held else why, held[3] + 1 if held else 1]
                if held[3] >= JOIN and not inside:
                    flush()
            if leaves >= MAX_LEAVES:
                events.append(Event("undecided", b, t1, "scan stopped"))
                return events
        flush()
        return events

    def clear(self, a, b):
        return self.examine(a, b)[0] == "none"

    def normal(self, T):
        """Certified unit gradient at the root enclosure T, or None."""
        P = self.point(T)
        JUMP[0] = False
        g = [self.s.dual(*P, *(ONE if i == k else ZERO for i in range(3)))[1] for k in range(3)]
        if JUMP[0] or not all(c.is_finite() for c in g):
            return None
        big = max(float(c.abs_upper().log()) if not c.is_zero() else -math.inf for c in g)
        if big == -math.inf:
            return None
        s = (-arb(big)).exp()                   # 1e-300-scaled gradients and the like
        g = [c * s for c in g]
        n = sum(c * c for c in g)
        if not n > 0:
            return None
        n = n.sqrt()
        g = [c / n for c in g]
        if any(not c.is_finite() or float(c.rad()) > 1e-12 for c in g):
            return None
        return [float(c.mid()) for c in g]


def decide(surface, ray, t0, t1):
    """-> (status, t or None, normal or None, events)"""
    if not t0 <= t1:
        return "miss", None, None, []
    ctx.prec = PREC
    tr = Tracer(surface, *ray)
    events = tr.scan(t0, t1)
    margin = END * max(abs(t0), abs(t1))
    first = events[0] if events else None
    at_end = None
    if not tr.clear(t0 - margin, t0):
        at_end = t0
    elif first is not None and first.status == "hit" and first.t < t0 + margin:
        at_end = float(first.t.mid())
    elif first is None and not tr.clear(t1, t1 + margin):
        at_end = t1
    elif first is not None and first.status == "hit" and first.t > t1 - margin:
        at_end = float(first.t.mid())
    if at_end is not None and not (first is not None and first.reason.startswith("plateau")):
        events.insert(0, Event("undecided", at_end, at_end, "root at the clipped end"))
        first = events[0]
    if first is None:
        return "miss", None, None, events
    if first.status == "hit":
        normal = tr.normal(first.t)
        if normal is None and first.reason == "simple":     # ill-conditioned: place it better
            ctx.prec = 4 * HIGH_PREC
            normal = tr.normal(tr.newton(first.lo, first.hi, 1e-90))
            ctx.prec = PREC
        return "hit", float(first.t.mid()), normal, events
    return first.status, first.lo, None, events


# ---- rays ------------------------------------------------------------------
ORTHO_DIR = (0.3, -0.5, -0.81)
EYE_DIR = (-0.62, 0.35, -0.70)


def unit(v):
    n = math.sqrt(sum(c * c for c in v))
    return tuple(c / n for c in v)


def frame(d):
    h = (0.0, 0.0, 1.0) if abs(d[2]) < 0.9 else (1.0, 0.0, 0.0)
    u = unit((d[1] * h[2] - d[2] * h[1], d[2] * h[0] - d[0] * h[2], d[0] * h[1] - d[1] * h[0]))
    return u, (d[1] * u[2] - d[2] * u[1], d[2] * u[0] - d[0] * u[2], d[0] * u[1] - d[1] * u[0])


def along(p, *terms):
    for k, v in terms:
        p = tuple(a + k * b for a, b in zip(p, v))
    return p


def grid(n):
    """Generic (unsymmetric) cell offsets in [-1, 1]^2."""
    return [(2 * (i + 0.513) / n - 1, 2 * (j + 0.491) / n - 1) for j in range(n) for i in range(n)]


def make_rays(scene):
    lo, hi = scene["box"][:3], scene["box"][3:]
    c = tuple(0.5 * (a + b) for a, b in zip(lo, hi))
    diag = math.dist(lo, hi)
    R = 0.5 * diag
    rays = []

    def ortho(n, centre, radius):
        d = unit(ORTHO_DIR)
        u, v = frame(d)
        for p, q in grid(n):
            rays.append((along(centre, (p * radius, u), (q * radius, v), (-1.5 * R, d)), d))
    ortho(24, c, R)
    d = unit(EYE_DIR)
    u, v = frame(d)
    eye = along(c, (-2.5 * diag, d))
    for p, q in grid(16):
        target = along(c, (p * R, u), (q * R, v))
        rays.append((eye, unit(tuple(a - b for a, b in zip(target, eye)))))
    if "focus" in scene:                        # small features: a bundle aimed at them
        ortho(12, tuple(scene["focus"][:3]), scene["focus"][3])
    return rays


def clip(ray, box):
    """Slab clip in doubles; nan, nan when the ray misses the box."""
    t0, t1 = -math.inf, math.inf
    for o, d, lo, hi in zip(*ray, box[:3], box[3:]):
        if d == 0:
            if not lo <= o <= hi:
                return math.nan, math.nan
            continue
        a, b = sorted(((lo - o) / d, (hi - o) / d))
        t0, t1 = max(t0, a), min(t1, b)
    t0 = max(t0, 0.0)
    return (t0, t1) if t0 < t1 else (math.nan, math.nan)


# ---- driver ------------------------------------------------------------------
def g17(v):
    return "nan" if v is None or v != v else f"{v:.17g}"


def run_scene(scene, out, cap):
    surface = Surface(scene["formula"], scene["level"])
    rays = make_rays(scene)
    n = len(rays)
    stride = next(k for k in range(int(0.618 * n), n) if math.gcd(k, n) == 1)
    start, rows, aux = time.monotonic(), {}, {}
    for k in range(n):
        if time.monotonic() - start > cap:
            break
        i = k * stride % n                      # a time-out leaves an even sample
        t0, t1 = clip(rays[i], scene["box"])
        status, t, normal, events = decide(surface, rays[i], t0, t1)
        o, d = rays[i]
        rows[i] = [*map(g17, (*o, *d, t0, t1)), status, g17(t), *map(g17, normal or [None] * 3)]
        if status not in ("hit", "miss"):
            e = events[0]
            later = next((f for f in events if f.status == "hit"), None)
            ended = events[-1].reason in ("work limit", "scan stopped")
            aux[i] = [status, e.reason, g17(e.lo), g17(e.hi),
                      "hit" if later else "unknown" if ended else "none",
                      g17(later and float(later.t.mid()))]
    took = time.monotonic() - start
    counts = {s: sum(r[8] == s for r in rows.values()) for s in ("hit", "miss", "touch", "undecided")}
    order = sorted(rows)
    with open(out / f"{scene['name']}.csv", "w", newline="") as f:
        f.write(f"# {scene['name']}: {len(rows)} of {n} rays ({'complete' if len(rows) == n else 'time cap'}); "
                f"24x24 orthographic, 16x16 perspective{', 12x12 focus' if 'focus' in scene else ''}; "
                f"{took:.1f} s\n")
        w = csv.writer(f)
        w.writerow("ox oy oz dx dy dz t0 t1 status t nx ny nz".split())
        w.writerows(rows[i] for i in order)
    with open(out / f"{scene['name']}.aux.csv", "w", newline="") as f:
        w = csv.writer(f)
        w.writerow("row status reason lo hi next t_next".split())
        w.writerows([order.index(i), *aux[i]] for i in sorted(aux))
    reasons = {}
    for a in aux.values():
        reasons[a[0] + ": " + a[1]] = reasons.get(a[0] + ": " + a[1], 0) + 1
    nonormal = sum(r[8] == "hit" and r[10] == "nan" for r in rows.values())
    print(f"{scene['name']:22s} {len(rows):4d}/{n:<4d} " + " ".join(f"{s}={c}" for s, c in counts.items())
          + (f" no_normal={nonormal}" if nonormal else "") + f"  {took:.1f}s  {reasons or ''}", flush=True)


def load(path=DATA / "scenes.toml"):
    with open(path, "rb") as f:
        return tomllib.load(f)["scene"]


def main():
    ap = argparse.ArgumentParser()
    ap.add_argument("scenes", nargs="*")
    ap.add_argument("--cap", type=float, default=30)
    ap.add_argument("--out", type=pathlib.Path, default=DATA / "hits")
    a = ap.parse_args()
    a.out.mkdir(parents=True, exist_ok=True)
    scenes = load()
    unknown = set(a.scenes) - {s["name"] for s in scenes}
    if unknown:
        sys.exit(f"no such scene: {sorted(unknown)}")
    for s in scenes:
        if not a.scenes or s["name"] in a.scenes:
            run_scene(s, a.out, a.cap)


if __name__ == "__main__":
    main()
