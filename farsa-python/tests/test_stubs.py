"""The committed stubs list exactly what the compiled module has."""

import ast
import inspect
from pathlib import Path

import farsa_gym
from farsa_gym import _farsa_gym


def names(function):
    arguments = function.args
    return [argument.arg for argument in (*arguments.posonlyargs, *arguments.args, *arguments.kwonlyargs)]


def compare(function, runtime, place):
    signature = inspect.signature(runtime)
    assert [name for name in names(function) if name != "cls"] == list(signature.parameters), place
    optional = [name for name, value in signature.parameters.items() if value.default is not inspect.Parameter.empty]
    assert len(function.args.defaults) == len(optional), place


def test_stubs_agree_with_the_module():
    stub = ast.parse(Path(farsa_gym.__file__).with_name("_farsa_gym.pyi").read_text())
    listed = set()
    for item in stub.body:
        if isinstance(item, ast.FunctionDef):
            listed.add(item.name)
            compare(item, getattr(_farsa_gym, item.name), item.name)
        elif isinstance(item, ast.ClassDef):
            listed.add(item.name)
            runtime = getattr(_farsa_gym, item.name)
            members = {"__new__"}
            for member in item.body:
                if isinstance(member, ast.AnnAssign):
                    members.add(member.target.id)
                    assert not callable(getattr(runtime, member.target.id)), member.target.id
                else:
                    members.add(member.name)
                    compare(member, runtime if member.name == "__new__" else getattr(runtime, member.name), member.name)
            assert members - {"__new__"} == {name for name in vars(runtime) if not name.startswith("__")}, item.name
    assert listed == {name for name in vars(_farsa_gym) if not name.startswith("__")}


def test_public_names_are_documented():
    for name in farsa_gym.__all__:
        assert getattr(farsa_gym, name).__doc__, name
    assert Path(farsa_gym.__file__).with_name("py.typed").exists()
