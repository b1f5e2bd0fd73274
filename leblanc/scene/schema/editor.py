"""The JSON schema of a machine file, by which editors complete keys and show what each is."""

from __future__ import annotations

from typing import Any

from pydantic.json_schema import GenerateJsonSchema, JsonSchemaValue

from leblanc.scene.schema.part import Part, allowed_at, parts_of, rule_of
from leblanc.scene.schema.paths import tables_of


class _Plain(GenerateJsonSchema):
    """Defaults stand where JSON can say them."""

    def default_schema(self, schema: Any) -> JsonSchemaValue:
        """Of a value with a default."""
        plain = isinstance(schema.get("default"), bool | int | float | str)
        return super().default_schema(schema) if plain else self.generate_inner(schema["schema"])


def machine_schema(root: type[Part]) -> dict[str, Any]:
    """JSON schema of a machine file, draft 2020-12: what the models that check it say of each key.

    `root`: that of the whole file, `leblanc.scene.scene.Scene`.
    """
    made = root.model_json_schema(schema_generator=_Plain)
    tables: dict[str, type[Part]] = {"": root}
    for kind in parts_of(root.model_fields["rotor"]):
        tables |= {part.__name__: part for part in tables_of(root, kind).values()}
    for name, part in tables.items():
        said = made if name == "" else made["$defs"].get(name)
        if said is None:
            continue
        said["description"] = (part.__doc__ or "").partition("\n")[0]
        said.pop("title", None)
        for key, field in part.model_fields.items():
            entry = said["properties"][key]
            entry.pop("title", None)
            if (rule := rule_of(field)) is not None:
                entry |= getattr(rule, "schema", {})
                entry["description"] = f"{field.description or key}: {allowed_at(field)}"
    return {"$schema": "https://json-schema.org/draft/2020-12/schema", "title": "Machine of leblanc"} | made
