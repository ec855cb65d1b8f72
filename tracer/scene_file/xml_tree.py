"""The elements of an XML file, each with the line it stands on. What an attacker could use is refused."""

from typing import NamedTuple
from xml.sax import SAXException, SAXParseException
from xml.sax.handler import ContentHandler

from defusedxml import DefusedXmlException, sax

from tracer.settings import TracerError

DEEPEST = 32  # elements within elements; a scene needs five


class Element(NamedTuple):
    """One element: <tag attribute="...">children</tag>."""

    tag: str
    attributes: dict
    children: list
    where: str  # "FILE: line N"

    def get(self, name):
        """The text of an attribute; TracerError if it is missing."""
        if name not in self.attributes:
            raise TracerError(f'{self.where}: <{self.tag}>: needs {name}="..."')
        return self.attributes[name]

    def only(self, *known):
        """TracerError for the first attribute that is not among `known`."""
        for name in self.attributes:
            if name not in known:
                raise TracerError(
                    f"{self.where}: <{self.tag} {name}>: unknown attribute; known here: {', '.join(known)}"
                )

    def alone(self):
        """TracerError if there are elements inside."""
        for child in self.children:
            raise TracerError(f"{child.where}: <{child.tag}>: nothing may stand inside <{self.tag}>")


class _Tree(ContentHandler):
    """Collects the elements as the parser meets them."""

    def __init__(self, path):
        super().__init__()
        self.path, self.root = path, None
        self._open, self._locator = [], None

    def setDocumentLocator(self, locator):
        self._locator = locator

    def where(self):
        """File and line that the parser is at."""
        return f"{self.path}: line {self._locator.getLineNumber() if self._locator else 1}"

    def startElement(self, name, attrs):
        element = Element(name, dict(attrs.items()), [], self.where())
        if self._open:
            self._open[-1].children.append(element)
        else:
            self.root = element
        self._open.append(element)
        if len(self._open) > DEEPEST:
            raise TracerError(f"{self.where()}: is nested too deeply to be a scene")

    def endElement(self, name):
        self._open.pop()

    def characters(self, content):
        if content.strip():
            text = content.strip()[:30]
            raise TracerError(f"{self.where()}: {text!r}: text between elements means nothing here")


def parse(path):
    """The root Element of a file. Raises TracerError naming file and line."""
    try:
        source = path.read_bytes()
    except OSError as error:
        raise TracerError(f"{path}: cannot be read: {error.strerror or error}") from None
    tree = _Tree(path)
    try:
        sax.parseString(source, tree, forbid_dtd=True)
    except SAXParseException as error:
        line = f"line {error.getLineNumber()}, column {error.getColumnNumber()}"
        raise TracerError(f"{path}: {line}: is not correct XML: {error.getMessage()}") from None
    except DefusedXmlException:
        raise TracerError(
            f"{tree.where()}: document types and entities are not read; take them out"
        ) from None
    except TracerError:
        raise
    except (SAXException, ValueError, LookupError) as error:  # an encoding that the parser lacks
        raise TracerError(f"{tree.where()}: cannot be read as XML: {error}; save it as UTF-8") from None
    return tree.root
