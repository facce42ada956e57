"""Draws a plane or axisymmetric solution: deformed cells, coloured by von Mises stress.   picture.py solution.vtu > picture.svg

Options: --window x0 x1 y0 y1 (deformed coordinates), --greatest s (stress of the last colour; default: 98th percentile).
"""
import argparse

from vtu import vtu_arrays

WIDTH = 900  # pixels
COLOURS = [(43, 60, 140), (62, 135, 189), (120, 195, 170), (215, 225, 140), (250, 180, 90), (225, 90, 60), (150, 20, 45)]


def colour(share):
    place = min(max(share, 0), 1) * (len(COLOURS) - 1)
    i = min(int(place), len(COLOURS) - 2)
    return "#" + "".join(f"{round(a + (place - i) * (b - a)):02x}" for a, b in zip(COLOURS[i], COLOURS[i + 1]))


def cells(arrays):
    begin = 0
    for end in arrays["offsets"]:
        yield arrays["connectivity"][begin:end]
        begin = end


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("file")
    parser.add_argument("--window", type=float, nargs=4)
    parser.add_argument("--greatest", type=float)
    options = parser.parse_args()
    arrays = vtu_arrays(options.file)
    points, displacement, stress = arrays["Points"], arrays["displacement"], arrays["von_mises"]
    place = [(points[i] + displacement[i], points[i + 1] + displacement[i + 1]) for i in range(0, len(points), 3)]
    x0, x1, y0, y1 = options.window or (min(p[0] for p in place), max(p[0] for p in place),
                                        min(p[1] for p in place), max(p[1] for p in place))
    scale = WIDTH / (x1 - x0)
    greatest = options.greatest or sorted(stress)[int(0.98 * (len(stress) - 1))] or 1

    print(f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {scale * (y1 - y0) + 40:.0f}" '
          'font-family="sans-serif" font-size="14"><g stroke="#ffffff" stroke-width="0.3" stroke-opacity="0.6">')
    for cell, value in zip(cells(arrays), stress):
        corners = [(scale * (place[i][0] - x0), scale * (y1 - place[i][1])) for i in cell]
        if all(0 <= x <= WIDTH and 0 <= y <= scale * (y1 - y0) for x, y in corners):
            path = " ".join(f"{x:.1f},{y:.1f}" for x, y in corners)
            print(f'<polygon points="{path}" fill="{colour(value / greatest)}"/>')
    print("</g>")
    bottom = scale * (y1 - y0) + 12
    for k in range(100):
        print(f'<rect x="{10 + 2 * k}" y="{bottom:.0f}" width="2" height="12" fill="{colour(k / 99)}"/>')
    print(f'<text x="216" y="{bottom + 11:.0f}">von Mises stress, 0 to {greatest:.3g}</text></svg>')


if __name__ == "__main__":
    main()
