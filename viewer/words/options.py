"""What the options of single commands mean, in other languages; the English stands in each command's docstring.

option.COMMAND.NAME, or option.NAME where several commands have the same one.
"""

WORDS = {
    "zh": {
        "option.json": "只打印一份 JSON 文档。",
        "option.help": "显示本说明后退出。",
        "option.version": "显示版本后退出。",
        # castray view
        "option.view.what": "场景文件，或 castray 自带场景的名字（默认：cornell_unit）；查看器地址栏里的链接；castray render --record 写出的文件夹（castray query 会指出其中的位置：DIR#x=..&y=..&path=..）；或 castray render 写出的 .exr，与它所画的场景对比。也可以是你自己的追踪器（FILE.py，同 castray check；每次保存都会重新运行）或它的日志（FILE.jsonl），再加 --scene；也可以带上其中的位置：FILE#x=..&y=..&path=..&event=..。",
        "option.view.scene": "你自己的追踪器或日志所用的场景（追踪器的默认：cornell）。",
        "option.view.lesson": "打开这一课和它的场景，不再另选场景。",
        "option.view.port": "在 127.0.0.1 的哪个端口监听（默认：任一空闲端口）。",
        "option.view.browser": "如有浏览器就打开它。",
        "option.view.compare": "图像与什么对比：错误动物园中的一种错误；right，即没有错误的追踪器；一个图像文件，例如你自己的；或一份记录的文件夹。",
        "option.view.engine": "由谁画图像：numpy；gl，在显卡上（需要 moderngl 和 OpenGL 4.1），它做不到的，例如植入的错误，由 NumPy 来画；或 auto：有显卡就用 gl。点选的路径由 NumPy 追踪：除舍入外几乎都相同。",
        # castray render
        "option.render.scene": "场景文件，或 castray 自带场景的名字。",
        "option.render.output": "图像写到哪里；不写则为当前文件夹里的 SCENE.png。",
        "option.render.engine": "numpy；gl，在显卡上追踪（需要 moderngl 和 OpenGL 4.1），图像除舍入外相同；或 auto：有显卡、且它做得到所要求的，就用 gl。",
        "option.render.workers": "最多用多少个进程（默认：每个核心一个）。无论多少，图像都相同。",
        "option.render.cluster": "dask.distributed 调度器的地址，例如 tcp://127.0.0.1:8786，由它的工作进程来做（需要软件包 distributed，那里也要有 castray）。那些机器与本机同类时，图像相同。中断之后，用同一条命令接着做。",
        "option.render.until_error": "图像按 16 x 16 像素分块，一块的相对误差（se^2 / (mean^2 + 0.01) 的均方根）小到这个值就停下；此时 --spp 是上限（不写则为 4096）。",
        "option.render.adaptive": "mse 或 relmse：先用每像素 16 个样本测量，再把 --spp 中其余的样本用在这种误差大的地方，平均数不变。",
        "option.render.record": "把路径保存在这个文件夹里，供 castray query 和 castray view 使用。如果同样的记录以前已经开始，就接着做。图像不变。",
        "option.render.record_level": "paths：每条路径一行（默认）；events：发生的一切，每个顶点约 200 字节。",
        "option.render.explain": "说明这个场景需要什么，略去了什么，以及为什么。",
        # castray inspect
        "option.inspect.scene": "场景文件，或 castray 自带场景的名字。",
        "option.inspect.pixel": "列和行，左上角是 0 0。",
        "option.inspect.sample": "只看该像素的这一个样本（默认：全部，并逐个事件显示最亮的一个）。",
        "option.inspect.what_if": "显示该样本假如是另一种情形：DEPTH.KIND=VALUE，例如 1.bounce=30,45（与法线的夹角和绕法线的转角，以度计）、0.light=0.2,0.3,0.9（光源采样的随机数）、4.roulette=survive（或 stop）。",
        "option.inspect.why": "改为说明该像素为什么是黑的，或为什么是这个值：用句子给出理由，离原因最近的在前，并按深度和采样方式列出组成；加上 --json 时，这两项与其余内容一起给出。",
        "option.inspect.html": "同时把三维路径写到这里：一个无需网络就能打开的网页。",
        "option.inspect.event": "改看 --sample 的这个事件所在的顶点：它的向量，从那里反弹的去向与其概率密度的对照，f 背后的各项，以及光线的两端，精确到 ulp。",
        # castray doctor
        "option.doctor.what": "场景文件，或 castray 自带场景的名字：按路径选项追踪它。也可以是 castray render --record 加 --record-level events 写出的文件夹，或另一个追踪器的日志 FILE.jsonl（castray log --schema）。或者是你的追踪器画出的图像（.png、.ppm、.exr、.npy 等）。",
        "option.doctor.scene": "日志或图像所用的场景。",
        "option.doctor.html": "同时把报告写到这里：一个无需网络就能打开的网页，其中有第一项发现的路径的三维视图。",
        "option.doctor.gamma": "对于图像：写入之前对光取了多少次幂；作业里是 0.6。",
        "option.doctor.output": "对于图像：把它、正确的图像和两者之比并排写进这个文件。",
        "option.doctor.size": "宽度和高度，以像素计（默认：依场景，缩小到较长的一边为 64）",
        # castray twin
        "option.twin.what": "一个场景，再加 --bug：正确的追踪器与错误的追踪器并排。或一份追踪记录，旁边是另一份：castray render --record 加 --record-level events 写出的文件夹，或某个追踪器的日志 FILE.jsonl。",
        "option.twin.other": "另一份追踪记录。",
        "option.twin.scene": "日志所用的场景。",
        "option.twin.limit": "最多列出多少条差别最大的路径。",
        "option.twin.exact": "每一位都算；否则同一个数的不同舍入视为相同。",
        "option.twin.size": "宽度和高度，以像素计（默认：依场景，缩小到较长的一边为 64）",
        # castray query
        "option.query.trace": "castray render --record 写出的文件夹。",
        "option.query.text": "对视图 events 的条件（只记录了路径时则是 paths），或一条 SELECT。向量写作 p.x，颜色写作 beta.r；宏有 dot(n, wi)、length(p)，以及用于颜色的 luminance、largest、smallest、no_number。",
        "option.query.break": "一个有名字的断点。nan：吞吐量、概率密度、BSDF 值或贡献中出现 NaN 或无穷大；negative：为负的贡献；largest：最大的贡献；near：交点的距离 t 小于 0.0001；roulette：继续概率低于 0.05 的轮盘赌；self：光源采样被它出发的表面挡住，或被 castray 在那里找不到的东西挡住。",
        "option.query.mask": "一幅图像：在灰度图像上标出这些路径在哪里（.png）。",
        "option.query.limit": "最多显示多少条路径或多少行。",
        "option.query.seconds": "一次查询最多用多少秒。",
        "option.query.schema": "说明一份记录由什么组成：文件、视图，每一列的含义和单位。",
        # castray diff
        "option.diff.a": "要评判的图像。",
        "option.diff.b": "作为参照的图像。",
        "option.diff.output": "差别图写到哪里，a 较暗处为蓝，较亮处为红：每个像素的 z，及其周围的 Z，直到 ±5。",
        "option.diff.alpha": "两幅都正确的图像被说成不同的概率。",
        # castray check
        "option.check.file": "一个有函数 cast_ray(scene, ray, depth) 的 Python 文件，或一个装着多份作业的文件夹。",
        "option.check.scene": "让它追踪什么：场景文件，或 castray 自带场景的名字。",
        "option.check.new": "只把一个可以从它开始的追踪器写进该文件。",
        "option.check.seconds": "每一份最多用多少秒。",
        "option.check.csv": "对于文件夹：给电子表格用的表写到哪里。",
        "option.check.html": "对于文件夹：表写成网页放到哪里；它不需要别的文件，并带有每项发现的证据。",
        "option.check.size": "宽度和高度，以像素计（默认：24 24）",
        # castray bsdf
        "option.bsdf.name": "一种材质（roughconductor）、一种金属（Au），或一种透明物质（bk7、water）。",
        "option.bsdf.parameters": "材质的词，写法同场景文件：alpha=0.2、diffuse_reflectance=[0.8,0.2,0.1]。",
        "option.bsdf.output": "图画到哪里，.png 或 .svg；不写就不画。",
        "option.bsdf.[keyword]": "同样的词，写成选项：--alpha 0.2。",
        # castray bench
        "option.bench.scenes": "场景文件，或 castray 自带场景的名字。",
        "option.bench.integrator": "只测这一个；重复写则测多个（默认：walk、direct 和 path）。",
        "option.bench.strategy": "只测 path 的这一种，或多种（默认：mis、light 和 bsdf）。",
        "option.bench.sampler": "只测这一种，或多种。",
        "option.bench.precision": "只测这一种，或多种。",
        "option.bench.adaptive": "样本用在哪里：off、mse 或 relmse，同 castray render；可写多个（默认：off）。",
        "option.bench.spp": "每像素的样本数，一个或多个（默认：4 16 64）。",
        "option.bench.seeds": "每种画多少幅图像：用 --seed 之后的种子；--seed 本身属于参照图像。",
        "option.bench.reference": "当作真值的图像：castray render 的 .exr，它自身的误差会计入；或 .npy。不写则用 path 画一幅。",
        "option.bench.reference_spp": "自己画参照图像时每像素的样本数（默认：所测最大值的 16 倍）。",
        "option.bench.workers": "多少个进程来渲染。",
        "option.bench.output": "曲线图画到哪里，.png 或 .svg；不写就不画。",
        "option.bench.size": "宽度和高度，以像素计（默认：依场景，缩小到较长的一边为 64）",
        # castray export
        "option.export.scene": "场景文件，或 castray 自带场景的名字。",
        "option.export.output": "XML 写到哪里；不写则为当前文件夹里的 SCENE.xml。网格留在原处：在它的文件夹里或其下的，从那里起命名；其他的写出完整路径。",
        # castray log
        "option.log.file": "JSON Lines 格式的日志。",
        "option.log.scene": "它所用的场景：场景文件，或 castray 自带场景的名字。",
        "option.log.schema": "打印说明该格式的文档。",
        "option.log.header": "把供 C++ 记录日志的 castray.h 写到那里。",
        # castray bugs
        "option.bugs.bug_id": "错误动物园中的一种错误。",
        "option.bugs.thumbnails": "放小图像的文件夹，文件名为 ID.png：左边是错误的，右边是正确的。",
        # castray lesson
        "option.lesson.number": "第几课。",
        "option.lesson.check": "题目的名字和你的回答：--check window 2.5；像素则写 --check 120 80（不写名字：第一道还没有解出的题）。",
        "option.lesson.hint": "这道题的下一条提示。",
        "option.lesson.solution": "这道题怎样解；请先自己试试。",
        "option.lesson.site": "把课程写成网页放到那里，无需网络就能打开：全部，或只有该编号的一课。",
        "option.lesson.solutions": "网页是否写出题目的解法。",
    },
}
