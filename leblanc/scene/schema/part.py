"""A table of a scene as a frozen model, and the messages of its faults."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import cache
from typing import Annotated, Any, ClassVar, NamedTuple, Self, get_args, get_origin

from pydantic import (
    BaseModel,
    ConfigDict,
    ModelWrapValidatorHandler,
    TypeAdapter,
    ValidationError,
    model_validator,
)
from pydantic.fields import FieldInfo
from pydantic_core import ErrorDetails, InitErrorDetails, PydanticCustomError

from leblanc.core.units import allowed_as_typed
from leblanc.scene.schema.load import SceneError, SceneFault, field_path, meant, shown
from leblanc.scene.schema.rules import OneOf, Refused
from meshes.errors import InputError

MAX_FAULTS = 100  # that are reported; a file of another kind has millions
_TOGETHER, _ABSENT = "together", "absent"  # names of faults that no single value has
# Tag of tables of other packages; in the place of a fault the kind of the table follows it.
ANNOUNCED = "announced"


class Conflict(NamedTuple):
    """Values that do not go together.

    `keys` of the value to name, from the table on; `allowed` in words that follow "must be".
    """

    keys: tuple[str | int, ...]
    allowed: str


class Part(BaseModel):
    """A table whose keys are all known and whose values do not change.

    A table from a file and keywords in Python are checked alike: quantities are SI numbers or texts with
    units.

    Raises
    ------
    SceneError : with everything that is wrong
    """

    model_config = ConfigDict(extra="forbid", frozen=True)

    # Pairs of keys of which exactly one must be given.
    ALTERNATIVES: ClassVar[tuple[tuple[str, str], ...]] = ()
    # The kind is what a table without one has: a file does not say it.
    USUAL_KIND: ClassVar[bool] = False

    @classmethod
    def alternatives(cls) -> tuple[type[Part], ...]:
        """Tables that may stand where this one is asked for: itself, or what other packages announce."""
        return (cls,)

    def __init__(self, /, **values: Any) -> None:
        try:
            super().__init__(**values)
        except ValidationError as error:
            raise SceneError(faults_of(error, type(self).__name__, type(self))) from None

    # Tables within tables are made by the validator, which collects the faults of all.
    __init__.__pydantic_base_init__ = True  # type: ignore[attr-defined]

    @classmethod
    def __pydantic_init_subclass__(cls, **kwargs: Any) -> None:
        """Show types in the signature, not what checks them."""
        super().__pydantic_init_subclass__(**kwargs)
        cls.__signature__ = _Signed()  # type: ignore[assignment]

    def __copy__(self) -> Self:
        """The same values without what was worked out from them, which is another's after a change."""
        copied, fields = super().__copy__(), type(self).model_fields
        if len(copied.__dict__) > len(fields):
            for name in copied.__dict__.keys() - fields.keys():
                del copied.__dict__[name]
        return copied

    def altered(self, **values: Any) -> Self:
        """The same with other values, which are taken as they are: checked, in SI units."""
        return self.model_copy(update=values)

    def table(self) -> dict[str, Any]:
        """What a file would say: the keys that were given, quantities in SI units."""
        found = {}
        for name, field in type(self).model_fields.items():
            value = getattr(self, name)
            said = name in self.model_fields_set or (name == "kind" and not self.USUAL_KIND)
            if value is None or not said:
                continue
            written = getattr(rule_of(field), "written", _written)
            found[name] = written(value)
        return found

    @classmethod
    def as_table(cls, given: Any) -> Any:
        """What is given as a file would say it; a part may take objects of the solvers as well."""
        return given

    @classmethod
    def conflicts(cls, values: Mapping[str, Any], given: Mapping[str, Any]) -> Iterator[Conflict]:
        """Values that break a rule together.

        `values` are checked, in SI units, those without a fault of their own; `given` is what the file says.
        """
        for first, other in cls.ALTERNATIVES:
            if (first in given) != (other in given):
                continue
            text = f"exactly one of {first} and {other}"
            if first in given:
                yield Conflict((other,), f"given alone: {text}")
            else:
                yield Conflict((first,), f"given: {text}")

    @model_validator(mode="wrap")
    @classmethod
    def _check(cls, given: Any, handler: ModelWrapValidatorHandler[Self]) -> Self:
        """Each value by itself, then all together; a wrong value does not keep the others from that."""
        given = cls.as_table(given)
        try:
            made = handler(given)
        except ValidationError as error:
            if isinstance(given, Mapping):
                raise _with_conflicts(cls, error, given) from None
            raise
        if made is not given and (found := list(cls.conflicts(made.__dict__, given))):
            raise ValidationError.from_exception_data(
                cls.__name__, [_line(conflict, given) for conflict in found]
            )
        if made is not given:
            made.__dict__.update(made.implied())
        return made

    def implied(self) -> dict[str, Any]:
        """Values of keys that follow from others, in SI units; a file does not say them."""
        return {}


class _Signed:
    """The signature of a table, made when somebody asks for it."""

    def __get__(self, _: object, owner: type[BaseModel]) -> Any:
        from leblanc.core.question import of_fields

        return of_fields(owner.model_fields)


def _written(value: Any) -> Any:
    """A value as a file says it."""
    if isinstance(value, Part):
        return value.table()
    return [_written(entry) for entry in value] if isinstance(value, tuple) else value


def _with_conflicts(cls: type[Part], error: ValidationError, given: Mapping[str, Any]) -> ValidationError:
    """The faults of single values and those of the others together, in the order of the fields."""
    lines = [_again(item) for item in error.errors(include_url=False)]
    wrong = {line["loc"][0] for line in lines if line.get("loc")}
    values = {
        name: _adapter(cls, name).validate_python(given[name]) if name in given else field.default
        for name, field in cls.model_fields.items()
        if name not in wrong
    }
    lines += [_line(conflict, given) for conflict in cls.conflicts(values, given)]
    order = {name: k for k, name in enumerate(cls.model_fields)}
    lines.sort(key=lambda line: order.get(str(line["loc"][0]), len(order)) if line.get("loc") else -1)
    return ValidationError.from_exception_data(cls.__name__, lines)


def _line(conflict: Conflict, given: Mapping[str, Any]) -> InitErrorDetails:
    """A conflict as pydantic keeps it."""
    value: Any = given
    for key in conflict.keys:
        if isinstance(value, Part):
            value = getattr(value, str(key))
        else:
            value = value.get(key) if isinstance(value, Mapping) else value[key]
    missing = len(conflict.keys) > 1 and value is None
    kind = _TOGETHER if conflict.keys[0] in given and not missing else _ABSENT
    custom = PydanticCustomError(kind, "{allowed}", {"allowed": conflict.allowed})
    return InitErrorDetails(type=custom, loc=conflict.keys, input=value)


def placed(error: ValidationError, *place: str) -> ValidationError:
    """The same faults at a place further in."""
    lines = [_again(item) for item in error.errors(include_url=False)]
    for line in lines:
        line["loc"] = (*place, *line.get("loc", ()))
    return ValidationError.from_exception_data(error.title, lines)


def _again(item: ErrorDetails) -> InitErrorDetails:
    """A fault that pydantic found, to be raised once more."""
    kind: Any = item["type"]
    if kind in (_TOGETHER, _ABSENT):
        kind = PydanticCustomError(kind, "{allowed}", item["ctx"])
        return InitErrorDetails(type=kind, loc=item["loc"], input=item["input"])
    return InitErrorDetails(type=kind, loc=item["loc"], input=item["input"], ctx=item.get("ctx", {}))


@cache
def _adapter(cls: type[Part], name: str) -> TypeAdapter[Any]:
    """What checks one field alone."""
    field = cls.model_fields[name]
    annotation: Any = Annotated[field.annotation, field]
    return TypeAdapter(annotation)


def rule_of(field: FieldInfo) -> Any:
    """Rule of a field: a callable with `allowed`, see leblanc.scene.schema.rules; None if it is a table."""
    return next((rule.func for rule in field.metadata if hasattr(rule, "func")), None)


def parts_of(field: FieldInfo) -> dict[str, type[Part]]:
    """Tables that may stand at a field, or as entries of its list, by their kind.

    Several by their kinds, a single one under "", none for plain values.
    """
    table = getattr(rule_of(field), "table", None)
    found = [table] if table is not None else list(_parts_in(field.annotation))
    if len(found) < 2:
        return dict(zip([""], found, strict=False))
    return {part.model_fields["kind"].default: part for part in found}


def _parts_in(annotation: Any) -> Iterator[type[Part]]:
    if isinstance(annotation, type) and issubclass(annotation, Part):
        yield from annotation.alternatives()
    elif get_origin(annotation) is Annotated:
        yield from _parts_in(get_args(annotation)[0])
    else:
        for inside in get_args(annotation):
            yield from _parts_in(inside)


def allowed_at(field: FieldInfo) -> str:
    """What may stand at a field, in words."""
    rule = rule_of(field)
    if rule is not None:
        return str(rule.allowed)
    first = next(iter(parts_of(field).values()))
    return "a table of " + ", ".join(first.model_fields)


def faults_of(error: ValidationError, file: str, root: type[Part]) -> list[SceneFault]:
    """What pydantic found, in words for a user, at most `MAX_FAULTS` of it.

    `root`: the table that it checked.
    """
    found = error.errors(include_url=False)
    faults = [_fault(item, file, root) for item in found[:MAX_FAULTS]]
    if len(found) > MAX_FAULTS:
        faults.append(SceneFault(file, "", None, f"free of {len(found) - MAX_FAULTS} more faults"))
    return faults


def _fault(item: ErrorDetails, file: str, root: type[Part]) -> SceneFault:
    keys, owner, field = _way(item["loc"], root)
    kind, value = item["type"], shown(item["input"])
    cause = item.get("ctx", {}).get("error")
    if kind in (_TOGETHER, _ABSENT):
        given = value if kind == _TOGETHER else None
        allowed = allowed_as_typed(item["ctx"]["allowed"], item["input"])
        return SceneFault(file, field_path(keys), given, allowed)
    if isinstance(cause, InputError | Refused):
        return SceneFault(file, field_path(keys), value, allowed_as_typed(cause.allowed, item["input"]))
    if kind == "extra_forbidden":
        names = list(owner.model_fields)
        text = f"left out or spelled as one of: {', '.join(names)}{meant(keys[-1], names)}"
        return SceneFault(file, field_path(keys), value, text)
    if kind in ("union_tag_invalid", "union_tag_not_found") and field is not None:
        return _kind_fault(item, file, keys, field)
    allowed = "a table of " + ", ".join(owner.model_fields) if field is None else allowed_at(field)
    if kind == "missing":
        return SceneFault(file, field_path(keys), None, f"given: {allowed}")
    return SceneFault(file, field_path(keys), value, allowed)


def _kind_fault(item: ErrorDetails, file: str, keys: tuple[str | int, ...], field: FieldInfo) -> SceneFault:
    """A table of which the kind is not known, and so neither what it may hold."""
    rule, given = OneOf(tuple(parts_of(field))), item["input"]
    path = field_path((*keys, "kind"))
    if not isinstance(given, Mapping) or "kind" not in given:
        return SceneFault(file, path, None, f"given: {rule.allowed}")
    return SceneFault(file, path, shown(given["kind"]), rule.allowed + meant(given["kind"], rule.names))


def _way(
    loc: tuple[str | int, ...], root: type[Part]
) -> tuple[tuple[str | int, ...], type[Part], FieldInfo | None]:
    """Keys as a file has them, the last table on the way and its field; None for a table in a list."""
    keys: list[str | int] = []
    owner, field = root, None
    kinds: dict[str, type[Part]] = {}
    for key in loc:
        if key == ANNOUNCED and field is not None:
            continue
        if key in kinds and "" not in kinds and field is not None:
            owner, kinds, field = kinds[str(key)], {}, None  # the kind, which is no key of its own
            continue
        if isinstance(key, int):
            keys.append(key)
            if "" in kinds:
                owner, kinds, field = kinds[""], {}, None
            continue
        if "" in kinds:
            owner = kinds[""]
        keys.append(key)
        field = owner.model_fields.get(key)
        kinds = {} if field is None else parts_of(field)
    return tuple(keys), owner, field
