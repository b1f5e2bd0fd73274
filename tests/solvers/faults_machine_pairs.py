"""Seeded faults of many machines at once."""

from __future__ import annotations

from tests.faults import Fault
from tests.solvers import test_branches, test_hydrostatics, test_response
from tests.solvers import test_machine_pairs as oracle

PAIRS, RESPONSE, BRANCHES = (
    "solvers.synchronous.pairs",
    "solvers.synchronous.planar",
    "solvers.synchronous.branches",
)

FAULTS: tuple[Fault, ...] = (
    Fault(PAIRS, "elastic + 1j * self.damping", "elastic - 1j * self.damping", oracle.check_sums),
    Fault(
        PAIRS,
        "here.added_mass, here.mass * here.chamber.radius",
        "here.added_mass, here.mass",
        oracle.check_sums,
    ),
    Fault(PAIRS, "place = index[owner]", "place = index[owner[::-1]]", oracle.check_each_as_if_alone),
    Fault(PAIRS, "moment - fills.mass * e", "moment", oracle.check_sums),
    Fault(PAIRS, "(law.unbalance, law.slope))", "(law.slope, law.unbalance))", oracle.check_sums),
    Fault(PAIRS, "moment = fills.added_mass * e", "moment = fills.mass * e", oracle.check_sums),
    Fault(PAIRS, "moment[bent] = law.unbalance", "moment[bent] = law.slope", oracle.check_sums),
    Fault(
        "fluid.fill", "return self.density * self.volume", "return self.volume", oracle.check_arrays_of_fills
    ),
    Fault(
        "fluid.fill",
        "return film / (self.chamber.radius + self.surface_radius)",
        "return film / (2.0 * self.chamber.radius)",
        oracle.check_arrays_of_fills,
    ),
    Fault(
        "meshes.chamber",
        "(self.radius - self.inner_radius) * (self.radius + self.inner_radius)\n        return np",
        "(self.radius - self.inner_radius) * self.radius\n        return np",
        test_hydrostatics.check_many_chambers,
    ),
    Fault(
        "solvers.statics.integrals",
        "np.asarray(chamber.inner_radius) / chamber.radius, 1e-60",
        "np.max(chamber.inner_radius) / chamber.radius, 1e-60",
        test_hydrostatics.check_many_chambers,
    ),
    Fault(BRANCHES, "for slope in (a - rise, a)", "for slope in (a,)", test_response.check_all_branches),
    Fault(BRANCHES, "+ np.square(c) * low", "+ np.square(c) * high * 4.0", test_branches.check_one_way),
    Fault("solvers.whirl.growth", "support[own[place]].T", "support[place].T", oracle.check_growth),
    Fault(
        "solvers.whirl.growth",
        "mass = np.array([tables[i][0] for i in own])[place]",
        "mass = np.array([tables[0][0] for i in own])[place]",
        oracle.check_growth,
    ),
)
