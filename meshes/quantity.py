"""What a number of an answer is, said once: beside it, in its type."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Q:
    """A quantity of an answer: `amplitude: Annotated[Array, Q("m", "amplitude", over=("speed",))]`.

    It stands at a field of a dataclass or at what a property returns; JSON, data files, tables and the page
    of outputs are made from it. In its unit, name and text "{0.paths}" stands for an attribute of the answer.
    """

    unit: str = ""  #: as CF writes it ("rad s-1", "1"); empty for texts, truth values and records
    name: str = ""  #: what it is, a noun phrase that stands alone
    text: str = ""  #: what else a reader needs: "zero to peak", from where an angle counts
    over: tuple[str, ...] = ()  #: names of its dimensions; a quantity over itself alone is a coordinate
    axes: tuple[str, str] | None = None  #: of a complex number: what lies along its two axes
    flags: str = ""  #: names of the states of a truth value, a text or a code, the last being 1
    error: str = ""  #: the quantity that is its error
    by: str = ""  #: its equation, as in "rotor, eq. 28"
    key: str = ""  #: its public name, where that is not the attribute's
    variable: str = ""  #: its name in the data file, where that is another
    json: bool = True  #: it stands in the JSON
    data: bool = True  #: it is a variable of the data file
    coordinate: bool = False  #: a scalar that the others belong to, as the one speed of an answer
    when: str = ""  #: it is left out where this attribute is None or an empty tuple
    part: bool = False  #: a record, whose own quantities are the answer's as well
    #: a record, nested in the JSON; those without a `variable` named after it: "prefix_speed"
    prefix: str = ""
    rows: str = ""  #: records along this dimension; those without a `variable` named after it: "check_speed"
    only: tuple[str, ...] = ()  #: of such a record these quantities alone
    #: attribute of a table that is nan where there is nothing: rows of the JSON have what is there alone
    sparse: str = ""
