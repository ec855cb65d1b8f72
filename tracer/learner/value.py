"""Numbers that remember which factors they were made of.

A value is a sum of terms, a term a number times powers of leaves: an f that a material gave, a cosine, a
density, a radiance. Sums, products and quotients by a single term keep that; whatever else is done to a value
gives a plain float, of which nothing is known but how large it is.
"""

import operator
from collections.abc import Callable
from typing import Any

import numpy as np

_OPERATORS: dict[Any, Callable] = {
    np.add: operator.add,
    np.subtract: operator.sub,
    np.multiply: operator.mul,
    np.divide: operator.truediv,
    np.negative: operator.neg,
    np.absolute: abs,
}


class Leaf:
    """One number or colour that was handed out, and what it is."""

    __slots__ = ("kind", "of", "value")

    def __init__(self, kind, value, **of):
        self.kind, self.value, self.of = kind, value, of


class ForNumPy:
    """What NumPy's functions make of a value or vector: arithmetic and products of vectors remember as ever,
    everything else takes the plain numbers."""

    __slots__ = ()
    _beside: Callable  # what stands beside one in arithmetic, as its like

    def __array__(self, dtype=None, copy=None):
        return np.array(plain_of(self), dtype)

    def __array_ufunc__(self, ufunc, method, *inputs, **options):
        way = _OPERATORS.get(ufunc)
        if way is not None and method == "__call__" and options.keys() <= {"out"}:  # of a += b
            return way(*(x if isinstance(x, ForNumPy) else self._beside(x) for x in inputs))
        return getattr(ufunc, method)(*map(plain_of, inputs), **options)

    def __array_function__(self, function, types, inputs, options):
        way = _PRODUCTS.get(function)
        if way is not None and not options and not any(isinstance(x, Value) for x in inputs):
            return way(*inputs)
        return function(*map(plain_of, inputs), **options)


class Value(ForNumPy):
    """A number or colour (3,) as a sum of terms (plain factor, ((leaf, power), ...))."""

    __slots__ = ("terms", "value")

    def __init__(self, value, terms):
        self.value, self.terms = value, terms

    @staticmethod
    def _beside(other):
        return known(other)

    def __len__(self):
        return len(self.value)

    def __getitem__(self, channel):
        return named("number", self.value[channel])

    def __add__(self, other):
        other = known(other)
        return Value(self.value + other.value, self.terms + other.terms)

    __radd__ = __add__

    def __neg__(self):
        return -1.0 * self

    def __sub__(self, other):
        return self + -1.0 * known(other)

    def __rsub__(self, other):
        return known(other) - self

    def __mul__(self, other):
        if isinstance(other, Vector):
            return other * float(self)
        other = known(other)
        terms = tuple((a * b, _joined(p, q)) for a, p in self.terms for b, q in other.terms)
        return Value(self.value * other.value, terms)

    __rmul__ = __mul__

    def __truediv__(self, other):
        other = known(other)
        with np.errstate(all="ignore"):  # who divides by 0 gets infinity or NaN, and the doctor sees it
            if len(other.terms) == 1:
                ((factor, powers),) = other.terms
                inverse = Value(np.divide(1.0, other.value), ((np.divide(1.0, factor), _inverse(powers)),))
            else:
                inverse = named("number", np.divide(1.0, other.value))
            return self * inverse

    def __rtruediv__(self, other):
        return known(other) / self

    def __pow__(self, power):
        if isinstance(power, int) and 0 < power < 9:
            found = self
            for _ in range(power - 1):
                found = found * self
            return found
        return float(self) ** power

    def __abs__(self):
        return -self if self.value < 0.0 else self

    def __float__(self):
        return float(self.value)

    def __bool__(self):
        return bool(np.any(self.value != 0.0))

    def __lt__(self, other):
        return self._compared(other, lambda a, b: a < b)

    def __le__(self, other):
        return self._compared(other, lambda a, b: a <= b)

    def __gt__(self, other):
        return self._compared(other, lambda a, b: a > b)

    def __ge__(self, other):
        return self._compared(other, lambda a, b: a >= b)

    def _compared(self, other, way):
        """The comparison; a random number remembers with what it was compared, and how that went."""
        plain = plain_of(other)
        answer = bool(way(self.value, plain))
        if len(self.terms) == 1:  # not of what was made from it, as in max(0, 1 - u)
            ((factor, powers),) = self.terms
            if np.all(factor == 1.0) and len(powers) == 1 and powers[0][0].kind == "random":
                powers[0][0].of.update(against=float(plain), outcome=answer)
        return answer

    @property
    def r(self):
        """The red channel."""
        return self[0]

    @property
    def g(self):
        """The green channel."""
        return self[1]

    @property
    def b(self):
        """The blue channel."""
        return self[2]

    def __repr__(self):
        return repr(self.value)


class Vector(ForNumPy):
    """A point or direction: x, y, z. Sums, differences, multiples; `*` of two is component by component."""

    __slots__ = ("x", "y", "z")

    def __init__(self, x, y, z):
        self.x, self.y, self.z = float(x), float(y), float(z)

    @staticmethod
    def _beside(other):
        return vector(other) if np.ndim(other) else float(other)

    def __iter__(self):
        return iter((self.x, self.y, self.z))

    def __len__(self):
        return 3

    def __getitem__(self, axis):
        return (self.x, self.y, self.z)[axis]

    def __add__(self, other):
        other = vector(other)
        return Vector(self.x + other.x, self.y + other.y, self.z + other.z)

    __radd__ = __add__

    def __sub__(self, other):
        other = vector(other)
        return Vector(self.x - other.x, self.y - other.y, self.z - other.z)

    def __rsub__(self, other):
        return vector(other) - self

    def __neg__(self):
        return Vector(-self.x, -self.y, -self.z)

    def __mul__(self, other):
        if isinstance(other, Vector):
            return Vector(self.x * other.x, self.y * other.y, self.z * other.z)
        other = float(other)
        return Vector(self.x * other, self.y * other, self.z * other)

    __rmul__ = __mul__

    def __truediv__(self, other):
        return self * (1.0 / float(other))

    def __repr__(self):
        return f"Vector({self.x!r}, {self.y!r}, {self.z!r})"

    @property
    def plain(self):
        """(3,) array."""
        return np.array((self.x, self.y, self.z))


class Point(Vector):
    """A point on a surface, which remembers on which flat face it lies."""

    __slots__ = ("face",)

    def __init__(self, p, face):
        super().__init__(*p)
        self.face = face


def named(kind, value, **of):
    """A value that is one leaf."""
    return Value(value, ((1.0, ((Leaf(kind, value, **of), 1),)),))


def known(other):
    """A Value as it is; a plain number or colour as a Value without leaves."""
    if isinstance(other, Value):
        return other
    if isinstance(other, (int, float)):
        return Value(float(other), ((float(other), ()),) if other else ())
    plain = np.asarray(tuple(other) if isinstance(other, Vector) else other, np.float64)
    if plain.shape not in ((), (3,)):
        raise TypeError(f"a number or a colour of three is needed here, not shape {plain.shape}")
    return Value(plain, ((plain, ()),) if plain.any() else ())


def plain_of(value):
    """The number, colour or vector without what it remembers."""
    if isinstance(value, Vector):
        return value.plain
    return value.value if isinstance(value, Value) else value


def vector(a):
    """A Vector as it is; any other three numbers as one."""
    return a if isinstance(a, Vector) else Vector(*a)


def dot(a, b):
    """Dot product of two vectors, which remembers both."""
    a, b = vector(a), vector(b)
    return named("dot", a.x * b.x + a.y * b.y + a.z * b.z, a=a, b=b)


def cross(a, b):
    """Cross product of two vectors."""
    a, b = vector(a), vector(b)
    return Vector(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x)


def length(a):
    """Length of a vector, which remembers it."""
    a = vector(a)
    return named("length", float(np.sqrt(a.x * a.x + a.y * a.y + a.z * a.z)), a=a)


def normalize(a):
    """A vector of length 1 in the same direction."""
    return vector(a) / length(a).value


_PRODUCTS: dict[Any, Callable] = {
    np.dot: dot,
    np.inner: dot,
    np.vdot: dot,
    np.cross: cross,
    np.linalg.norm: length,
}


def _joined(p, q):
    found = dict(p)
    for leaf, power in q:
        found[leaf] = found.get(leaf, 0) + power
    return tuple((leaf, power) for leaf, power in found.items() if power)


def _inverse(powers):
    return tuple((leaf, -power) for leaf, power in powers)
