"""The symmetry of all sites in arrays: what maps each onto itself, and which motion names a copy."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from voronoi_tiles.base.arrays import Bools, Ints, offsets_of, ranges
from voronoi_tiles.vector.copies import Placed
from voronoi_tiles.vector.motion_codes import IDENTITY_CODE, Codes, composed, encode, modulo


@dataclass(frozen=True, eq=False, slots=True)
class SiteSymmetry:
    """The motions that map sites onto themselves: for site k `stabilizer[offsets[k] : offsets[k + 1]]`, identity first.

    `order` (intp, sites) is how many there are; `names` (bool, sites x 64) says which motions, modulo the lattice, name
    copies of the site. `general` is whether no site is mapped onto itself by any other motion than the identity.
    """

    stabilizer: Codes
    offsets: Ints
    order: Ints
    names: Bools
    general: bool

    @classmethod
    def of(cls, placed: Sequence[Placed]) -> SiteSymmetry:
        """That of placed sites."""
        order = np.array([len(p.stabilizer) for p in placed])
        names = np.zeros((len(placed), 64), bool)
        special = (order > 1).nonzero()[0]
        for k in special.tolist():
            names[k, modulo(encode(placed[k].representatives))] = True
        if len(special):
            stabilizer = encode([motion for p in placed for motion in p.stabilizer])
        else:
            stabilizer = np.full(len(placed), IDENTITY_CODE)
        return cls(stabilizer, offsets_of(order), order, names, not len(special))

    def canonical(self, site: Ints, motion: Codes) -> Codes:
        """The motions that name the copies onto which motions take sites; as `Placed.canonical`."""
        if self.general:
            return motion
        special = np.flatnonzero(self.order[site] > 1)
        which = np.repeat(special, self.order[site[special]])
        image = composed(motion[which], self.stabilizer[ranges(self.offsets[site[special]], self.order[site[special]])])
        named = np.flatnonzero(self.names[site[which], modulo(image)])
        result = motion.copy()
        result[which[named]] = image[named]
        return result
