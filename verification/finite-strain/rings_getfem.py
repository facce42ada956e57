"""The two rings of rings.yaml with GetFEM (Debian's python3-getfem): where the reference of case.py comes from.

    /usr/bin/python3 rings_getfem.py [cells in 0.3] [friction]

Quadratic quadrilaterals with the same law; GetFEM's own contact of large sliding (integrated along the lower ring's outside, met by rays along its
normals; the contact's traction is a linear field). Prints approach, and force of either ring's middle over E and the lower ring's radius.
"""
import sys

import getfem
import numpy

CELLS = int(sys.argv[1]) if len(sys.argv) > 1 else 16
FRICTION = float(sys.argv[2]) if len(sys.argv) > 2 else 0.0
DEPTH, STEPS = 0.6, 30
RINGS = {"lower": (0.6, 1.0, 1.0), "upper": (0.5, 0.8, 2.0)}  # inner and outer radius, Young's modulus
POISSON, CENTRE = 0.3, 1.8  # height of the upper ring's centre
AXIS, MIDDLE, OUTSIDE = 1, 2, 3


def meshed(name):
    """A quarter of a ring; the upper one's radii are negative, so that it lies below its centre."""
    inner, outer, _ = RINGS[name]
    upper = name == "upper"
    along, through = (round(CELLS * length / 0.3) for length in (numpy.pi / 4 * (inner + outer), outer - inner))
    mesh = getfem.Mesh("import", "structured", f'GT="GT_QK(2,2)";ORG=[0,{-outer if upper else inner}];'
                                               f'SIZES=[{numpy.pi / 2},{outer - inner}];NSUBDIV=[{along},{through}]')
    sides = mesh.outer_faces()
    normal = mesh.normal_of_faces(sides)
    outward = -normal[1] if upper else normal[1]
    for region, chosen in ((AXIS, normal[0] < -0.5), (MIDDLE, normal[0] > 0.5), (OUTSIDE, outward > 0.5)):
        mesh.set_region(region, sides[:, chosen])
    angle, radius = mesh.pts()
    mesh.set_pts(numpy.array([abs(radius) * numpy.sin(angle), (CENTRE if upper else 0) + radius * numpy.cos(angle)]))
    return mesh


class Ring:
    """A ring's variable u_<name>, its law and its supports in a model."""

    def __init__(self, model, name):
        self.model, self.variable = model, f"u_{name}"
        self.mesh, young = meshed(name), RINGS[name][2]
        self.field = getfem.MeshFem(self.mesh, 2)
        self.field.set_classical_fem(2)
        self.inside = getfem.MeshIm(self.mesh, getfem.Integ("IM_GAUSS_PARALLELEPIPED(2,6)"))
        self.touching = getfem.MeshIm(self.mesh, getfem.Integ("IM_STRUCTURED_COMPOSITE(IM_GAUSS_PARALLELEPIPED(2,4),2)"))
        model.add_fem_variable(self.variable, self.field)
        model.add_fem_data(f"w_{name}", self.field)
        shear, bulk = young / (2 * (1 + POISSON)), young / (3 * (1 - 2 * POISSON))
        gradient = f"(Id(2)+Grad_{self.variable})"
        volume, inverse = f"Det({gradient})", f"(Inv({gradient})')"
        self.virtual_work = (f"({shear}*pow({volume},-2/3)*({gradient}-(Norm_sqr({gradient})+1)/3*{inverse})"
                             f"+{bulk}/2*(sqr({volume})-1)*{inverse}):Grad_Test_{self.variable}")
        model.add_nonlinear_term(self.inside, self.virtual_work)
        for region, place, components in ((AXIS, "zero", "across"), (MIDDLE, f"middle_{name}", "upward")):
            model.add_generalized_Dirichlet_condition_with_multipliers(self.inside, self.variable, self.field, region, place, components)

    def force(self):
        """Of the middle on this half, upward."""
        residual = getfem.asm("generic", self.inside, 1, self.virtual_work, -1, self.model)
        first, n = self.model.interval_of_variable(self.variable)
        return residual[first:first + n][self.field.basic_dof_on_region(MIDDLE)[1::2]].sum()


def modelled():
    model = getfem.Model("real")
    for name, value in (("zero", [0, 0]), ("middle_lower", [0, 0]), ("middle_upper", [0, 0]), ("across", [[1, 0], [0, 0]]),
                        ("upward", [[0, 0], [0, 1]]), ("augmentation", [10.0]), ("alpha", [1.0]), ("friction", [FRICTION])):
        model.add_initialized_data(name, value)
    rings = {name: Ring(model, name) for name in RINGS}
    traction = getfem.MeshFem(rings["lower"].mesh, 2)
    traction.set_classical_fem(1)
    model.add_filtered_fem_variable("p", traction, OUTSIDE)
    contact = model.add_integral_large_sliding_contact_brick_raytracing("augmentation", 0.1, "friction", "alpha", 0)
    before = {name: f"w_{name}" if FRICTION else "" for name in RINGS}  # displacements of the step before
    model.add_slave_contact_boundary_to_large_sliding_contact_brick(contact, rings["lower"].touching, OUTSIDE, "u_lower", "p", before["lower"])
    model.add_master_contact_boundary_to_large_sliding_contact_brick(contact, rings["upper"].touching, OUTSIDE, "u_upper", before["upper"])
    return model, rings


def main():
    getfem.util("trace level", 0)
    model, rings = modelled()
    for step in range(1, STEPS + 1):
        depth = DEPTH * step / STEPS
        for name in RINGS:
            model.set_variable(f"w_{name}", model.variable(f"u_{name}"))
        model.set_variable("middle_upper", [0, -depth])
        model.solve("max_res", 1e-10, "max_iter", 60, "lsearch", "simplest", "alpha max ratio", 1.5, "alpha min", 0.2, "alpha mult", 0.6)
        print(f"{depth:.3f} " + " ".join(f"{2 * ring.force():.7f}" for ring in rings.values()), flush=True)


if __name__ == "__main__":
    main()
