"""One of the two like rings of like-rings.yaml, against a plate as in Code_Aster's test SSNP501, with GetFEM (Debian's python3-getfem).

    /usr/bin/python3 like_rings_getfem.py [saint-venant | neo-hookean]

On Code_Aster's mesh of bilinear quadrilaterals, with its law (Saint-Venant and Kirchhoff's in plane stress) or ours. Prints the share of the way, the
force of the contact, and the sum of the internal forces of the outside's nodes, the outermost node of the middle among them, which is what
Code_Aster's test states.
"""
import sys

import getfem
import numpy

LAW = sys.argv[1] if len(sys.argv) > 1 else "saint-venant"
INNER, OUTER, WAY, STEPS = 4.15, 6.35, 2.225, 40
YOUNG, POISSON = 407.0, 0.48
AXIS, MIDDLE, OUTSIDE = 1, 2, 3


def meshed():
    mesh = getfem.Mesh("import", "structured", f'GT="GT_QK(2,1)";ORG=[0,{INNER}];SIZES=[{numpy.pi / 2},{OUTER - INNER}];NSUBDIV=[40,6]')
    sides = mesh.outer_faces()
    normal = mesh.normal_of_faces(sides)
    for region, chosen in ((AXIS, normal[0] < -0.5), (MIDDLE, normal[0] > 0.5), (OUTSIDE, normal[1] > 0.5)):
        mesh.set_region(region, sides[:, chosen])
    angle, radius = mesh.pts()
    mesh.set_pts(numpy.array([radius * numpy.sin(angle), radius * numpy.cos(angle)]))
    return mesh


def add_law(model, mesh, inside):
    """Adds the law and gives its virtual work of the displacement; out of the plane neo-Hooke's stretch is an unknown of each integration point."""
    shear, bulk = YOUNG / (2 * (1 + POISSON)), YOUNG / (3 * (1 - 2 * POISSON))
    model.add_macro("F", "(Id(2)+Grad_u)")
    if LAW == "saint-venant":
        model.add_macro("E", "((F'*F-Id(2))/2)")
        work = f"(F*({YOUNG * POISSON / (1 - POISSON**2)}*Trace(E)*Id(2)+{2 * shear}*E)):Grad_Test_u"
    else:
        stretch = getfem.MeshFem(mesh, 1)
        stretch.set_classical_discontinuous_fem(1)
        model.add_fem_variable("s", stretch)
        model.set_variable("s", numpy.ones(stretch.nbdof()))
        model.add_macro("J", "(Det(F)*s)")
        model.add_macro("I1", "(Norm_sqr(F)+sqr(s))")
        work = f"(({shear}*pow(J,-2/3)*(F-I1/3*Inv(F)')+{bulk}/2*(sqr(J)-1)*Inv(F)')):Grad_Test_u"
        model.add_nonlinear_term(inside, f"({shear}*pow(J,-2/3)*(s-I1/3/s)+{bulk}/2*(sqr(J)-1)/s)*Test_s")
    model.add_nonlinear_term(inside, work)
    return work


def main():
    getfem.util("trace level", 0)
    mesh, model = meshed(), getfem.Model("real")
    displacement, pressure = getfem.MeshFem(mesh, 2), getfem.MeshFem(mesh, 1)
    displacement.set_classical_fem(1)
    pressure.set_classical_fem(1)
    inside = getfem.MeshIm(mesh, getfem.Integ("IM_GAUSS_PARALLELEPIPED(2,3)"))
    touching = getfem.MeshIm(mesh, getfem.Integ("IM_STRUCTURED_COMPOSITE(IM_GAUSS_PARALLELEPIPED(2,4),8)"))
    model.add_fem_variable("u", displacement)
    model.add_filtered_fem_variable("p", pressure, OUTSIDE)
    for name, value in (("a", [YOUNG / 10]), ("plate", [OUTER]), ("zero", [0, 0]), ("across", [[1, 0], [0, 0]]), ("upward", [[0, 0], [0, 1]])):
        model.add_initialized_data(name, value)
    work = add_law(model, mesh, inside)
    model.add_macro("push", "pos_part(p-a*(plate-X(2)-u(2)))")
    model.add_nonlinear_term(touching, "push*Test_u(2)+(1/a)*(p-push)*Test_p", OUTSIDE)
    for region, components in ((AXIS, "across"), (MIDDLE, "upward")):
        model.add_generalized_Dirichlet_condition_with_multipliers(inside, "u", displacement, region, "zero", components)
    for step in range(1, STEPS + 1):
        model.set_variable("plate", [OUTER - WAY * step / STEPS])
        model.solve("max_res", 1e-9, "max_iter", 80)
        if step % 10 == 0:
            first, n = model.interval_of_variable("u")
            inner = getfem.asm("generic", inside, 1, work, -1, model)[first:first + n]
            force = getfem.asm("generic", touching, 0, "push", OUTSIDE, model)
            print(f"{step / STEPS:.2f} {force:.5f} {-inner[displacement.basic_dof_on_region(OUTSIDE)[1::2]].sum():.5f}", flush=True)


if __name__ == "__main__":
    main()
