#!/usr/bin/env python3
"""Writes a factory hall as OBJ and MTL: machines in bays, pipes, girders, columns, lamps.
Usage: factory.py MACHINES FOLDER. What is in it, and what is known of it: factory.md."""
import math
import os
import sys

BAY_X, BAY_Y, HEIGHT = 6.0, 5.0, 7.0
PIPE_RACK, CHORD, LAMP = 4.6, 5.6, 5.0  # heights of things over the bays
LAMP_HALF = (1.2, 0.2)

MATERIALS = {  # name: reflectance, exitance in W/m2
    "concrete": ((0.40, 0.39, 0.37), None),
    "wall": ((0.62, 0.62, 0.58), None),
    "roof": ((0.50, 0.52, 0.55), None),
    "steel": ((0.35, 0.38, 0.42), None),
    "green": ((0.22, 0.42, 0.30), None),
    "blue": ((0.18, 0.28, 0.52), None),
    "yellow": ((0.70, 0.55, 0.12), None),
    "tank": ((0.66, 0.66, 0.68), None),
    "pipe": ((0.55, 0.30, 0.16), None),
    "housing": ((0.75, 0.75, 0.75), None),
    "light": ((0.0, 0.0, 0.0), (900.0, 860.0, 760.0)),
}


class Numbers:
    """The same numbers in [0, 1) with every Python: Lehmer's generator modulo 2^31 - 1."""

    def __init__(self, seed):
        self.state = seed

    def __call__(self, low=0.0, high=1.0):
        self.state = self.state * 48271 % 2147483647
        return low + (high - low) * self.state / 2147483647

    def choose(self, of):
        return of[int(self(0, len(of)))]


class Obj:
    def __init__(self):
        self.points, self.ids, self.lines, self.polygons = [], {}, [], 0

    def group(self, name):
        self.lines.append("g " + name)

    def use(self, material):
        self.lines.append("usemtl " + material)

    def polygon(self, corners):
        ids = []
        for corner in corners:
            text = "%.6g %.6g %.6g" % tuple(round(x, 4) + 0.0 for x in corner)
            if text not in self.ids:
                self.points.append(text)
                self.ids[text] = len(self.points)
            ids.append(self.ids[text])
        self.lines.append("f " + " ".join(map(str, ids)))
        self.polygons += 1

    def prism(self, plan, low, high, bottom=True, top=True):
        """From a counter-clockwise plan: lists of (x, y), extruded along z."""
        n = len(plan)
        for k in range(n):
            (x, y), (u, v) = plan[k], plan[(k + 1) % n]
            self.polygon([(x, y, low), (u, v, low), (u, v, high), (x, y, high)])
        if bottom:
            self.polygon([(x, y, low) for x, y in reversed(plan)])
        if top:
            self.polygon([(x, y, high) for x, y in plan])

    def box(self, a, b, bottom=True, top=True):
        self.prism([(a[0], a[1]), (b[0], a[1]), (b[0], b[1]), (a[0], b[1])], a[2], b[2], bottom, top)

    def tube(self, a, b, radius, sides, caps=(True, True)):
        """A cylinder with that many sides from a to b."""
        axis = [q - p for p, q in zip(a, b)]
        length = math.sqrt(sum(x * x for x in axis))
        w = [x / length for x in axis]
        up = (0, 0, 1) if abs(w[2]) < 0.9 else (1, 0, 0)
        u = cross(up, w)
        size = math.sqrt(sum(x * x for x in u))
        u = [x / size for x in u]
        v = cross(w, u)
        ring = []
        for k in range(sides):
            c = radius * math.cos(2 * math.pi * (k + 0.5) / sides)
            s = radius * math.sin(2 * math.pi * (k + 0.5) / sides)
            ring.append([c * u[i] + s * v[i] for i in range(3)])
        at_a = [tuple(p + d for p, d in zip(a, r)) for r in ring]
        at_b = [tuple(p + d for p, d in zip(b, r)) for r in ring]
        for k in range(sides):
            m = (k + 1) % sides
            self.polygon([at_a[k], at_a[m], at_b[m], at_b[k]])
        if caps[0]:
            self.polygon(list(reversed(at_a)))
        if caps[1]:
            self.polygon(at_b)

    def write(self, folder, name):
        with open(os.path.join(folder, name + ".mtl"), "w", encoding="ascii") as file:
            for material, (reflectance, exitance) in MATERIALS.items():
                file.write("newmtl %s\nKd %g %g %g\n" % ((material,) + reflectance))
                if exitance:
                    file.write("Ke %g %g %g\n" % exitance)
        with open(os.path.join(folder, name + ".obj"), "w", encoding="ascii") as file:
            file.write("# A factory hall of %d polygons, metres, z up: data/factory.py\n" % self.polygons)
            file.write("mtllib %s.mtl\n" % name)
            file.writelines("v %s\n" % point for point in self.points)
            file.writelines(line + "\n" for line in self.lines)


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def circle(x, y, radius, sides):
    turns = [2 * math.pi * (k + 0.5) / sides for k in range(sides)]
    return [(x + radius * math.cos(t), y + radius * math.sin(t)) for t in turns]


def desk(obj, x, y):
    """A control desk with a sloping panel of buttons."""
    obj.use("steel")
    obj.box((x - 0.3, y - 0.2, 0), (x + 0.3, y + 0.2, 0.9), bottom=False)
    for i in range(4):
        for j in range(2):
            u, v = x - 0.2 + 0.12 * i, y - 0.1 + 0.14 * j
            obj.box((u, v, 0.9), (u + 0.05, v + 0.05, 0.93), bottom=False)


def press(obj, number, x, y, colour):
    """Four round posts between a bed and a head, a ram, a piece."""
    obj.use(colour)
    obj.box((x - 1.2, y - 0.8, 0), (x + 1.2, y + 0.8, 0.7), bottom=False)
    head = number(2.0, 2.6)
    obj.box((x - 1.2, y - 0.8, head), (x + 1.2, y + 0.8, head + 0.8))
    obj.use("steel")
    for dx in (-1, 1):
        for dy in (-0.6, 0.6):
            obj.prism(circle(x + dx, y + dy, 0.09, 12), 0.7, head, False, False)
    obj.prism(circle(x, y, 0.3, 16), head - 0.6, head, True, False)
    obj.box((x - 0.5, y - 0.4, 0.7), (x + 0.5, y + 0.4, 0.7 + number(0.2, 0.5)), bottom=False)
    for k in range(6):  # bolts
        obj.prism(circle(x - 1 + 0.4 * k, y, 0.05, 6), head + 0.8, head + 0.86, False)
    return head + 0.8


def tank(obj, number, x, y, colour):
    """A vessel on legs with hoops and a ladder."""
    radius, low, high = number(0.8, 1.1), 0.6, number(2.4, 3.2)
    obj.use("tank")
    obj.prism(circle(x, y, radius, 24), low, high)
    obj.use(colour)
    for k in range(3):
        z = low + 0.3 + k * (high - low - 0.6) / 2
        obj.prism(circle(x, y, radius + 0.05, 24), z, z + 0.08)
    obj.use("steel")
    for k in range(4):
        t = math.pi * (k + 0.5) / 2
        obj.prism(circle(x + 0.7 * radius * math.cos(t), y + 0.7 * radius * math.sin(t), 0.07, 8), 0, low, False, False)
    side = x + radius + 0.15
    for dy in (-0.22, 0.18):
        obj.box((side, y + dy, 0), (side + 0.04, y + dy + 0.04, high + 0.6), bottom=False)
    for k in range(9):
        z = 0.3 + k * (high - 0.3) / 8
        obj.tube((side + 0.02, y - 0.18, z), (side + 0.02, y + 0.18, z), 0.015, 6, (False, False))
    return high


def lathe(obj, number, x, y, colour):
    """A bed with headstock, chuck, workpiece, tailstock, carriage and handwheel."""
    obj.use(colour)
    obj.box((x - 1.6, y - 0.35, 0), (x + 1.6, y + 0.35, 0.8), bottom=False)
    obj.box((x - 1.6, y - 0.4, 0.8), (x - 0.9, y + 0.4, 1.5))
    obj.box((x + 1.1, y - 0.2, 0.8), (x + 1.5, y + 0.2, 1.3), bottom=False)
    obj.use("steel")
    obj.tube((x - 0.9, y, 1.15), (x - 0.65, y, 1.15), 0.25, 16, (False, True))
    obj.tube((x - 0.65, y, 1.15), (x + 1.1, y, 1.15), number(0.05, 0.12), 12, (False, False))
    slide = x + number(-0.4, 0.5)
    obj.box((slide, y - 0.45, 0.8), (slide + 0.4, y + 0.45, 0.95))
    obj.tube((slide + 0.2, y - 0.45, 0.7), (slide + 0.2, y - 0.5, 0.7), 0.14, 12)
    obj.use("yellow")
    for k in range(8):  # a fence of posts and rails before it
        u = x - 1.75 + 0.5 * k
        obj.prism(circle(u, y - 1.1, 0.025, 6), 0, 1.1, False)
    for z in (0.5, 1.0):
        obj.tube((x - 1.75, y - 1.1, z), (x + 1.75, y - 1.1, z), 0.02, 6)
    return 1.5


def cabinet(obj, number, x, y):
    """Switch gear with doors, handles and slits."""
    obj.use("steel")
    for k in range(3):
        u = x + 0.65 * k
        obj.box((u, y, 0), (u + 0.6, y + 0.5, 2.0), bottom=False)
        obj.box((u + 0.5, y - 0.03, 0.9), (u + 0.53, y, 1.1))
        for j in range(4):
            z = 1.5 + 0.1 * j
            obj.box((u + 0.1, y - 0.02, z), (u + 0.4, y, z + 0.03))


def piping(obj, number, x, y, top):
    """From the machine up to the rack, with elbows and flanges."""
    obj.use("pipe")
    for k in range(2):
        u, v, radius = x - 0.3 + 0.6 * k, y + 0.3, 0.06
        end = PIPE_RACK - 0.3 * k
        obj.tube((u, v, top), (u, v, end), radius, 10, (False, False))
        for z in (top + 0.2, end - 0.4):
            obj.tube((u, v, z), (u, v, z + 0.05), 0.12, 10)
        obj.tube((u, v, end), (u, y + 1.9, end), radius, 10)
        obj.tube((u, y + 1.2, end), (u, y + 1.25, end), 0.12, 10)


def machine(obj, number, k, x, y):
    obj.group("machine_%d" % (k + 1))
    colour = number.choose(["green", "blue", "yellow", "steel"])
    make = number.choose([press, tank, lathe])
    x, y = x + number(-0.3, 0.3), y + number(-0.2, 0.2)
    top = make(obj, number, x, y, colour)
    desk(obj, x - 2.1, y - 1.4)
    cabinet(obj, number, x + 0.1, y + 1.55)
    obj.group("pipes")
    piping(obj, number, x if make is not lathe else x - 1.25, y - (0.2 if make is lathe else 0), top)


def beam(obj, a, b, width, height, caps=(False, False)):
    """An I beam along x or y between the middles of its ends."""
    w, h, t = width / 2, height / 2, 0.02
    section = [(-w, -h), (w, -h), (w, t - h), (t, t - h), (t, h - t), (w, h - t),
               (w, h), (-w, h), (-w, h - t), (-t, h - t), (-t, t - h), (-w, t - h)]
    along_x = a[1] == b[1]
    place = lambda p, s: (p[0], p[1] + s[0], p[2] + s[1]) if along_x else (p[0] - s[0], p[1], p[2] + s[1])
    n = len(section)
    for k in range(n):
        s, t2 = section[k], section[(k + 1) % n]
        obj.polygon([place(a, s), place(b, s), place(b, t2), place(a, t2)][::-1])
    if caps[0]:
        obj.polygon([place(a, s) for s in section][::-1])
    if caps[1]:
        obj.polygon([place(b, s) for s in section])


def column(obj, x, y):
    w, t = 0.12, 0.02
    section = [(-w, -w), (w, -w), (w, t - w), (t, t - w), (t, w - t), (w, w - t),
               (w, w), (-w, w), (-w, w - t), (-t, w - t), (-t, t - w), (-w, t - w)]
    obj.prism([(x + u, y + v) for u, v in section], 0.03, CHORD, False)
    obj.box((x - 0.2, y - 0.2, 0), (x + 0.2, y + 0.2, 0.03), bottom=False)


def girders(obj, columns, rows):
    """Columns at the corners of bays; over them trusses along x: chords, posts, diagonals."""
    obj.group("girders")
    obj.use("steel")
    end = columns * BAY_X - 0.01
    for j in range(1, rows):
        y = j * BAY_Y
        beam(obj, (0.01, y, CHORD + 0.1), (end, y, CHORD + 0.1), 0.2, 0.2, (True, True))
        beam(obj, (0.01, y, HEIGHT - 0.15), (end, y, HEIGHT - 0.15), 0.2, 0.2, (True, True))
        for k in range(2 * columns):
            x, u = 0.1 + k * BAY_X / 2, 0.1 + (k + 1) * BAY_X / 2 - 0.2
            obj.tube((x, y, CHORD + 0.2), (u, y, HEIGHT - 0.25), 0.04, 6, (False, False))
            obj.box((u + 0.02, y - 0.03, CHORD + 0.2), (u + 0.08, y + 0.03, HEIGHT - 0.25), False, False)
        for i in range(1, columns):
            column(obj, i * BAY_X, y)


def racks(obj, columns, rows):
    """Pipes along the rows of machines, a piece a bay, flanges between, hangers."""
    obj.group("pipes")
    obj.use("pipe")
    end = columns * BAY_X - 0.05
    for j in range(rows):
        y = (j + 0.5) * BAY_Y + 2.1
        for k, radius in enumerate((0.1, 0.14)):
            z, step = PIPE_RACK - 0.3 * k, 3.0
            x = 0.05
            while x < end - 1e-9:
                u = min(x + step, end)
                obj.tube((x, y, z), (u, y, z), radius, 12, (x == 0.05, u == end))
                if u < end:
                    obj.tube((u - 0.03, y, z), (u + 0.03, y, z), radius + 0.06, 12)
                x = u


def lamps(obj, columns, rows):
    """In every other bay, the lower face shines."""
    count = 0
    for j in range(rows):
        for i in range(columns):
            if (i + j) % 2:
                continue
            count += 1
            obj.group("lamp_%d" % count)
            x, y = (i + 0.5) * BAY_X, (j + 0.5) * BAY_Y
            a, b = (x - LAMP_HALF[0], y - LAMP_HALF[1], LAMP), (x + LAMP_HALF[0], y + LAMP_HALF[1], LAMP + 0.12)
            obj.use("housing")
            obj.box(a, b, bottom=False)
            for dx in (-0.8, 0.8):
                obj.box((x + dx, y - 0.01, LAMP + 0.12), (x + dx + 0.02, y + 0.01, HEIGHT), False, False)
            obj.use("light")
            obj.polygon([(a[0], a[1], LAMP), (a[0], b[1], LAMP), (b[0], b[1], LAMP), (b[0], a[1], LAMP)])


def hall(obj, columns, rows):
    x, y, z = columns * BAY_X, rows * BAY_Y, HEIGHT
    faces = {
        "floor": ("concrete", [(0, 0, 0), (x, 0, 0), (x, y, 0), (0, y, 0)]),
        "roof": ("roof", [(0, 0, z), (0, y, z), (x, y, z), (x, 0, z)]),
        "wall_south": ("wall", [(0, 0, 0), (0, 0, z), (x, 0, z), (x, 0, 0)]),
        "wall_east": ("wall", [(x, 0, 0), (x, 0, z), (x, y, z), (x, y, 0)]),
        "wall_north": ("wall", [(x, y, 0), (x, y, z), (0, y, z), (0, y, 0)]),
        "wall_west": ("wall", [(0, y, 0), (0, y, z), (0, 0, z), (0, 0, 0)]),
    }
    for group, (material, corners) in faces.items():
        obj.group(group)
        obj.use(material)
        obj.polygon(corners)


def factory(machines):
    columns = max(1, math.ceil(math.sqrt(machines * BAY_Y / BAY_X)))
    rows = -(-machines // columns)
    obj, number = Obj(), Numbers(2027)
    hall(obj, columns, rows)
    for k in range(machines):
        machine(obj, number, k, (k % columns + 0.5) * BAY_X, (k // columns + 0.5) * BAY_Y)
    racks(obj, columns, rows)
    girders(obj, columns, rows)
    lamps(obj, columns, rows)
    return obj


def main():
    if len(sys.argv) != 3 or not sys.argv[1].isdecimal() or int(sys.argv[1]) < 1:
        sys.exit("usage: factory.py MACHINES FOLDER, with at least one machine")
    if not os.path.isdir(sys.argv[2]):
        sys.exit("factory.py: there is no folder '%s'" % sys.argv[2])
    obj = factory(int(sys.argv[1]))
    obj.write(sys.argv[2], "factory_" + sys.argv[1])
    print("%d polygons" % obj.polygons)


if __name__ == "__main__":
    main()
