import sys; sys.argv=['x','0','1']
exec(open('scratch/six.py').read().split("if __name__")[0])
if __name__=='__main__':
    jobs=[('taller',1.3,s) for s in (6,28,*range(40,52))]
    def go2(j):
        return go(j)
    with ProcessPoolExecutor(2) as e: r=[x for x in e.map(go,jobs) if x]
    print(len(jobs),'taller walks',r)
