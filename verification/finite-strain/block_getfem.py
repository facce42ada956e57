"""The block of block.yaml with GetFEM (Debian's python3-getfem): where the reference of case.py comes from.

    /usr/bin/python3 block_getfem.py [cells in the height]

Quadratic quadrilaterals with the same law; the contact's pressure is a linear field on the block's upper face, kept at or above
zero by an augmented Lagrangian, against the distance to the cylinder's centre where the face is now. Prints depth and force.
"""
import sys

import getfem
import numpy

CELLS = int(sys.argv[1]) if len(sys.argv) > 1 else 40
DEPTH, STEPS = 0.4, 20
YOUNG, POISSON, RADIUS = 1.0, 0.3, 1.0
BOTTOM, MIDDLE, TOP = 1, 2, 3


def meshed():
    mesh = getfem.Mesh("cartesian", numpy.linspace(0, 2, 2 * CELLS + 1), numpy.linspace(-1, 0, CELLS + 1))
    sides = mesh.outer_faces()
    normal = mesh.normal_of_faces(sides)
    for region, chosen in ((BOTTOM, normal[1] < -0.5), (MIDDLE, normal[0] < -0.5), (TOP, normal[1] > 0.5)):
        mesh.set_region(region, sides[:, chosen])
    return mesh


def modelled(mesh):
    """The model and the integration over the contact, in which each cell's side is cut in four."""
    displacement, pressure = getfem.MeshFem(mesh, 2), getfem.MeshFem(mesh, 1)
    displacement.set_fem(getfem.Fem("FEM_QK(2,2)"))
    pressure.set_fem(getfem.Fem("FEM_QK(2,1)"))
    inside = getfem.MeshIm(mesh, getfem.Integ("IM_GAUSS_PARALLELEPIPED(2,6)"))
    touching = getfem.MeshIm(mesh, getfem.Integ("IM_STRUCTURED_COMPOSITE(IM_GAUSS_PARALLELEPIPED(2,4),4)"))
    model = getfem.Model("real")
    model.add_fem_variable("u", displacement)
    model.add_filtered_fem_variable("p", pressure, TOP)
    for name, value in (("G", YOUNG / (2 * (1 + POISSON))), ("K", YOUNG / (3 * (1 - 2 * POISSON))), ("R", RADIUS),
                        ("a", 10 * YOUNG), ("centre", RADIUS)):
        model.add_initialized_data(name, [value])
    for name, expression in (("F", "(Id(2)+Grad_u)"), ("J", "Det(F)"), ("I1", "(Norm_sqr(F)+1)"), ("H", "(Inv(F)')"),
                             ("arm", "(X+u-[0;centre])"), ("push", "pos_part(p-a*(Norm(arm)-R))")):
        model.add_macro(name, expression)
    model.add_nonlinear_term(inside, "(G*pow(J,-2/3)*(F-I1/3*H)+K/2*(sqr(J)-1)*H):Grad_Test_u")
    model.add_nonlinear_term(touching, "-push*(arm/Norm(arm)).Test_u+(1/a)*(p-push)*Test_p", TOP)
    model.add_Dirichlet_condition_with_multipliers(inside, "u", displacement, BOTTOM)
    model.add_initialized_data("zero", [0, 0])
    model.add_initialized_data("across", [[1, 0], [0, 0]])
    model.add_generalized_Dirichlet_condition_with_multipliers(inside, "u", displacement, MIDDLE, "zero", "across")
    return model, touching


def main():
    getfem.util("trace level", 0)
    mesh = meshed()
    model, touching = modelled(mesh)
    for step in range(1, STEPS + 1):
        depth = DEPTH * step / STEPS
        model.set_variable("centre", [RADIUS - depth])
        model.solve("max_res", 1e-10, "max_iter", 60)
        force = getfem.asm("generic", touching, 0, "push*arm(2)/Norm(arm)", TOP, model)
        print(f"{depth:.3f} {-2 * force:.6f}", flush=True)


if __name__ == "__main__":
    main()
