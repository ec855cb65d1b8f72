"""The catalogue of usual mistakes: id and kind of each. Ids are stable."""

CATALOGUE = {
    "E01": "bias", "E02": "bias", "E03": "bias", "E04": "bias", "E06": "bias",
    "D01": "bias", "D02": "bias", "D03": "bias", "D04": "bias", "D06": "bias", "D07": "bias",
    "D08": "negative",
    "D10": "bias", "D11": "bias", "D13": "bias", "D14": "bias", "D15": "bias", "D17": "bias", "D18": "bias",
    "D20": "bias", "D21": "bias",
    "B01": "bias", "B02": "bias", "B03": "bias", "B04": "bias", "B05": "bias", "B08": "variance",
    "B09": "bias",
    "B10": "bias", "B12": "bias", "B14": "bias", "B15": "not a number", "B17": "bias", "B18": "bias",
    "R01": "bias", "R03": "bias", "R05": "bias", "R06": "variance", "R07": "cost",
    "G01": "bias", "G02": "bias", "G03": "bias", "G05": "bias", "G06": "cost", "G07": "holes", "G08": "bias",
    "G09": "bias",
    "P01": "cost", "P02": "frozen", "P03": "correlation", "P05": "picture", "P06": "picture", "P07": "cost",
    "F01": "bias", "F02": "picture", "F03": "bias", "F04": "bias", "F05": "aliasing", "F06": "picture",
    "S01": "bias", "S02": "not a number", "S04": "bias", "S06": "bias", "S07": "bias", "S08": "not a number",
    "S09": "bias",
    "M01": "bias", "M02": "bias",
    "N01": "bias", "N02": "bias", "N03": "bias", "N04": "bias",
    "W01": "bias", "W02": "bias", "W03": "bias", "W04": "bias",
}  # fmt: skip
# What the abandoned castRay had in it.
ABANDONED = ("E01", "D01", "D06", "D08", "D15", "B14", "B15", "R06", "P01")
# Entries that are no single mistake of the catalogue.
OURS = ("A01", "castray")
